#include "formats/polyhedra/measured_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "common/run/parallel.hpp"

namespace hexpipe::polyhedra {
namespace {

// A list that allocates only when it is long. Cells have few faces, and faces few corners, and millions are measured.
template <class T>
class Scratch {
 public:
  void add(const T& item) {
    if (count_ < few_.size()) {
      few_[count_++] = item;
      return;
    }
    if (count_ == few_.size()) many_.assign(few_.begin(), few_.end());
    many_.push_back(item);
    ++count_;
  }
  std::span<const T> span() const {
    return count_ <= few_.size() ? std::span<const T>(few_.data(), count_) : std::span<const T>(many_);
  }

 private:
  std::array<T, 12> few_;
  std::size_t count_ = 0;
  std::vector<T> many_;
};

Scratch<Vec3> corner_points(const PolyhedralMesh& mesh, const PolyhedralMesh::Face& face) {
  Scratch<Vec3> points;
  for (const Vertex v : mesh.corners_of(face)) points.add(mesh.points[v]);
  return points;
}

// A tet that is flatter than this, as a height by a length, counts as inverted: checkMesh wants a positive volume, and
// rounding must not decide.
constexpr double least_height = 1e-9;

// Whether the tets of a triangle with the centres of the two cells are positive. The triangle's normal points out of
// the owner; a facet of the boundary has no neighbour.
bool are_tets_positive(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& owner, const Vec3* neighbour) {
  const Vec3 normal = cross(b - a, c - a);
  const double longest = std::max({norm_squared(b - a), norm_squared(c - b), norm_squared(a - c)});
  const double size = norm(normal);
  if (!(size > least_height * longest)) return false;
  const auto rises = [&](const Vec3& line) { return dot(line, normal) > least_height * size * norm(line); };
  return rises(a - owner) && (neighbour == nullptr || rises(*neighbour - a));
}

// checkMesh cuts a face into triangles in two ways, both of which need positive tets: around its centre, and as a fan
// from one of its corners. It looks for a corner that will do.
bool has_inverted_tets(std::span<const Vec3> points, const FaceShape& shape, const Vec3& owner, const Vec3* neighbour) {
  const std::size_t count = points.size();
  if (count == 3) return !are_tets_positive(points[0], points[1], points[2], owner, neighbour);
  for (std::size_t i = 0; i < count; ++i)
    if (!are_tets_positive(points[i], points[(i + 1) % count], shape.centre, owner, neighbour)) return true;
  for (std::size_t base = 0; base < count; ++base) {
    bool all = true;
    for (std::size_t i = 1; all && i + 1 < count; ++i)
      all =
          are_tets_positive(points[base], points[(base + i) % count], points[(base + i + 1) % count], owner, neighbour);
    if (all) return false;
  }
  return true;
}

}  // namespace

MeasuredMesh::MeasuredMesh(PolyhedralMesh& mesh)
    : mesh_(mesh), shapes_(mesh.faces.size()), cells_(mesh.regions.size()) {
  for (const PolyhedralMesh::Face& face : mesh.faces) {
    ++cells_[face.owner].count;
    if (face.is_inner()) ++cells_[face.neighbour].count;
  }
  std::size_t count = 0;
  std::int32_t number = 0;
  for (Cell& cell : cells_) {
    cell.origin = number++;
    cell.begin = count;
    count += static_cast<std::size_t>(cell.count);
    cell.count = 0;
  }
  pool_.resize(count);
  const auto add = [&](std::int32_t cell, std::int32_t face) {
    pool_[cells_[cell].begin + static_cast<std::size_t>(cells_[cell].count++)] = face;
  };
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    add(mesh.faces[i].owner, static_cast<std::int32_t>(i));
    if (mesh.faces[i].is_inner()) add(mesh.faces[i].neighbour, static_cast<std::int32_t>(i));
  }
  constexpr std::int64_t grain = 4096;
  parallel_for(static_cast<std::int64_t>(shapes_.size()), grain,
               [&](std::int64_t face) { measure_face(static_cast<std::int32_t>(face)); });
  parallel_for(static_cast<std::int64_t>(cells_.size()), grain,
               [&](std::int64_t cell) { update_shape(static_cast<std::int32_t>(cell)); });
}

Refusals MeasuredMesh::refusals_of_cell(std::int32_t cell) const {
  Scratch<FaceShape> shapes;
  Scratch<Vec3> inner;
  for (const std::int32_t face : faces_of(cell)) {
    shapes.add({area(face, cell), shapes_[face].centre});
    if (mesh_.faces[face].is_inner()) inner.add(shapes_[face].area);
  }
  Refusals result = 0;
  if (cell_determinant(inner.span()) < low_determinant) result |= determinant;
  if (!is_convex(shapes.span())) result |= concave;
  return result;
}

double MeasuredMesh::trouble(std::int32_t cell) const {
  if ((refusals_of_cell(cell) & wrong) == 0) return 0;
  Scratch<Vec3> inner, normals;
  for (const std::int32_t face : faces_of(cell)) {
    normals.add(unit(area(face, cell)));
    if (mesh_.faces[face].is_inner()) inner.add(shapes_[face].area);
  }
  const std::span<const std::int32_t> faces = faces_of(cell);
  // Each face's centre has to lie behind the planes of the others, as is_convex() has it; a little further than it asks
  // for, so that the descent does not end on the limit.
  constexpr double clearly = 1e-5, positive = 1e-12;
  double trouble = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Vec3 line = unit(shapes_[faces[i]].centre - shapes_[faces[k]].centre);
      trouble +=
          std::max(0.0, dot(line, normals.span()[k]) + clearly) + std::max(0.0, clearly - dot(line, normals.span()[i]));
    }
  return trouble + std::max(0.0, 1 - cell_determinant(inner.span()) / low_determinant) + positive;
}

Refusals MeasuredMesh::refusals_of_face(std::int32_t number) const {
  static const double severe_cosine = std::cos(severe_angle);
  const PolyhedralMesh::Face& face = mesh_.faces[number];
  const FaceShape& shape = shapes_[number];
  const Cell& owner = cells_[face.owner];
  const Cell* const neighbour = face.is_inner() ? &cells_[face.neighbour] : nullptr;
  const Scratch<Vec3> scratch = corner_points(mesh_, face);
  const std::span<const Vec3> points = scratch.span();
  Refusals result = 0;
  if (has_inverted_tets(points, shape, owner.centre, neighbour ? &neighbour->centre : nullptr)) result |= face_tets;
  if (face_skewness(points, shape, owner.centre, neighbour ? &neighbour->centre : nullptr) > most_skewness)
    result |= skewness;
  if (neighbour == nullptr) return result;
  const double cosine = orthogonality(shape, owner.centre, neighbour->centre);
  if (cosine <= least_height) result |= orthogonality_of_90;
  if (cosine < severe_cosine) result |= severe;
  if (face_weight(shape, owner.centre, neighbour->centre) < low_weight) result |= weight;
  const auto [less, more] = std::minmax(owner.volume, neighbour->volume);
  if (less < low_volume_ratio * more) result |= volume_ratio;
  return result;
}

MeasuredMesh::Refused MeasuredMesh::refused() const {
  std::vector<Refusals> of_cells(cells_.size()), of_faces(shapes_.size());
  constexpr std::int64_t grain = 4096;
  parallel_for(static_cast<std::int64_t>(cells_.size()), grain, [&](std::int64_t cell) {
    if (cells_[cell].count > 0) of_cells[cell] = refusals_of_cell(static_cast<std::int32_t>(cell));
  });
  parallel_for(static_cast<std::int64_t>(shapes_.size()), grain, [&](std::int64_t face) {
    if (mesh_.faces[face].owner != no_index) of_faces[face] = refusals_of_face(static_cast<std::int32_t>(face));
  });
  Refused refused;
  const auto gather = [](const std::vector<Refusals>& all, std::vector<std::int32_t>& numbers) {
    for (std::size_t i = 0; i < all.size(); ++i)
      if ((all[i] & wrong) != 0) numbers.push_back(static_cast<std::int32_t>(i));
  };
  gather(of_cells, refused.cells);
  gather(of_faces, refused.faces);
  return refused;
}

MeasuredMesh::Refused MeasuredMesh::refused_after(const Refused& earlier) const {
  std::vector<std::int32_t> cells = earlier.cells, faces = earlier.faces;
  for (const std::int32_t cell : touched_) {
    if (static_cast<std::size_t>(cell) >= cells_.size()) continue;  // of a change that was taken back
    cells.push_back(cell);
    faces.insert(faces.end(), faces_of(cell).begin(), faces_of(cell).end());
  }
  Refused refused;
  const auto gather = [](std::vector<std::int32_t>& all, std::vector<std::int32_t>& numbers, auto&& is_wrong) {
    std::ranges::sort(all);
    all.erase(std::ranges::unique(all).begin(), all.end());
    std::ranges::copy_if(all, std::back_inserter(numbers), is_wrong);
  };
  gather(cells, refused.cells,
         [&](std::int32_t cell) { return is_alive(cell) && (refusals_of_cell(cell) & wrong) != 0; });
  gather(faces, refused.faces, [&](std::int32_t face) {
    return mesh_.faces[face].owner != no_index && (refusals_of_face(face) & wrong) != 0;
  });
  return refused;
}

Vertex MeasuredMesh::add_point(const Vec3& point) {
  mesh_.points.push_back(point);
  return Vertex(mesh_.points.size() - 1);
}

std::int32_t MeasuredMesh::add_face(std::span<const Vertex> loop, std::int32_t owner, std::int32_t neighbour,
                                    std::int32_t surface, bool flipped) {
  const std::int32_t face = mesh_.add_face(loop, owner, neighbour);
  mesh_.faces.back().surface = surface;
  mesh_.faces.back().flipped = flipped;
  shapes_.emplace_back();
  return face;
}

std::int32_t MeasuredMesh::add_cell_after(std::int32_t cell) {
  cells_.push_back({.origin = cells_[cell].origin});
  mesh_.regions.push_back(mesh_.regions[cell]);
  mesh_.is_hex.push_back(mesh_.is_hex[cell]);
  return static_cast<std::int32_t>(cells_.size()) - 1;
}

std::vector<std::int32_t> MeasuredMesh::order() const {
  std::vector<std::int32_t> cells;
  for (std::size_t cell = 0; cell < cells_.size(); ++cell)
    if (cells_[cell].count > 0) cells.push_back(static_cast<std::int32_t>(cell));
  std::ranges::stable_sort(cells, {}, [&](std::int32_t cell) { return cells_[cell].origin; });
  std::vector<std::int32_t> places(cells_.size(), no_index);
  for (std::size_t i = 0; i < cells.size(); ++i) places[cells[i]] = static_cast<std::int32_t>(i);
  return places;
}

void MeasuredMesh::set_sides(std::int32_t face, std::int32_t owner, std::int32_t neighbour) {
  mesh_.faces[face].owner = owner;
  mesh_.faces[face].neighbour = neighbour;
}

void MeasuredMesh::set_loop(std::int32_t face, std::span<const Vertex> loop) {
  mesh_.faces[face].begin = mesh_.corners.size();
  mesh_.faces[face].count = static_cast<std::int32_t>(loop.size());
  mesh_.corners.insert(mesh_.corners.end(), loop.begin(), loop.end());
}

void MeasuredMesh::set_surface(std::int32_t face, std::int32_t surface, bool flipped) {
  mesh_.faces[face].surface = surface;
  mesh_.faces[face].flipped = flipped;
}

void MeasuredMesh::set_faces(std::int32_t cell, std::span<const std::int32_t> faces) {
  cells_[cell].begin = pool_.size();
  cells_[cell].count = static_cast<std::int32_t>(faces.size());
  pool_.insert(pool_.end(), faces.begin(), faces.end());
}

void MeasuredMesh::measure_face(std::int32_t face) {
  shapes_[face] = face_shape(corner_points(mesh_, mesh_.faces[face]).span());
}

void MeasuredMesh::measure_cell(std::int32_t cell) {
  ++measurements_;
  if (is_touched_.size() < cells_.size()) is_touched_.resize(cells_.size());
  if (is_touched_[cell] == 0) {
    is_touched_[cell] = 1;
    touched_.push_back(cell);
  }
  update_shape(cell);
}

void MeasuredMesh::update_shape(std::int32_t cell) {
  Scratch<FaceShape> faces;
  for (const std::int32_t face : faces_of(cell)) faces.add({area(face, cell), shapes_[face].centre});
  const CellShape shape = cell_shape(faces.span());
  cells_[cell].centre = shape.centre;
  cells_[cell].volume = shape.volume;
}

MeasuredMesh::Undo::Undo(MeasuredMesh& mesh, std::span<const std::int32_t> cells)
    : mesh_(mesh),
      corner_count_(mesh.mesh_.corners.size()),
      face_count_(mesh.mesh_.faces.size()),
      cell_count_(mesh.cells_.size()),
      point_count_(mesh.mesh_.points.size()),
      pool_size_(mesh.pool_.size()) {
  for (const std::int32_t cell : cells) {
    cells_.emplace_back(cell, mesh.cells_[cell]);
    hexes_.push_back(mesh.mesh_.is_hex[cell]);
    for (const std::int32_t face : mesh.faces_of(cell))
      faces_.push_back({face, mesh.mesh_.faces[face], mesh.shapes_[face]});
  }
}

void MeasuredMesh::Undo::take_back() {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    mesh_.cells_[cells_[i].first] = cells_[i].second;
    mesh_.mesh_.is_hex[cells_[i].first] = hexes_[i];
  }
  for (const auto& [number, face, shape] : faces_) {
    mesh_.mesh_.faces[number] = face;
    mesh_.shapes_[number] = shape;
  }
  mesh_.mesh_.corners.resize(corner_count_);
  mesh_.mesh_.faces.resize(face_count_);
  mesh_.shapes_.resize(face_count_);
  mesh_.cells_.resize(cell_count_);
  mesh_.mesh_.regions.resize(cell_count_);
  mesh_.mesh_.is_hex.resize(cell_count_);
  mesh_.mesh_.points.resize(point_count_);
  mesh_.pool_.resize(pool_size_);
}

}  // namespace hexpipe::polyhedra
