#include "common/mesh/mesh_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/quality.hpp"

namespace hexpipe {
namespace {

// visit(kind, corners) for each cell.
template <class Visit>
void for_each_cell(const MixedMesh& mesh, Visit&& visit) {
  for (const auto& cell : mesh.hexes.cells) visit(CellKind::hex, std::span<const Vertex>(cell));
  for (const auto& cell : mesh.prisms.cells) visit(CellKind::prism, std::span<const Vertex>(cell));
  for (const auto& cell : mesh.pyramids.cells) visit(CellKind::pyramid, std::span<const Vertex>(cell));
  for (const auto& cell : mesh.tets.cells) visit(CellKind::tet, std::span<const Vertex>(cell));
}

// One side of a face. The keys and corners of triangles end in no_index.
struct Side {
  VertexKey<4> key;
  Quad corners;
  std::int32_t cell;
  std::uint8_t face;  // of the cell, triangles before quads
};

// A face, or two cells that have it between them.
struct MeasuredFace {
  const Side* behind;
  const Side* before;  // null on the boundary
  Vec3 centre;
  double orthogonality, weight, flatness;
};

class Faces {
 public:
  explicit Faces(const MixedMesh& mesh) : mesh_(mesh) {
    centres_.reserve(mesh.cell_count());
    for_each_cell(mesh, [&](CellKind kind, std::span<const Vertex> corners) { add_cell(kind, corners); });
    std::ranges::sort(sides_,
                      [](const Side& a, const Side& b) { return a.key != b.key ? a.key < b.key : a.cell < b.cell; });
  }

  const std::vector<Vec3>& centres() const { return centres_; }

  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const bool is_inner = i + 1 < sides_.size() && sides_[i].key == sides_[i + 1].key;
      visit(measured(sides_[i], is_inner ? &sides_[i + 1] : nullptr));
      if (is_inner) ++i;
    }
  }

  // By cell.
  std::vector<double> determinants() const {
    std::vector<std::array<std::uint8_t, 6>> inner(centres_.size());
    for_each([&](const MeasuredFace& face) {
      if (face.before == nullptr) return;
      for (const Side* const side : {face.behind, face.before}) inner[side->cell][side->face] = 1;
    });
    std::vector<double> result;
    result.reserve(centres_.size());
    for_each_cell(mesh_, [&](CellKind kind, std::span<const Vertex> corners) {
      const auto at = corner_points(mesh_.points, corners);
      result.push_back(cell_determinant(kind, std::span<const Vec3>(at).first(corners.size()), inner[result.size()]));
    });
    return result;
  }

 private:
  void add_cell(CellKind kind, std::span<const Vertex> corners) {
    std::uint8_t number = 0;
    const auto add = [&](const auto& faces) {
      for (const auto& face : faces) {
        Quad own{no_index, no_index, no_index, no_index};
        for (std::size_t i = 0; i < face.size(); ++i) own[i] = corners[face[i]];
        sides_.push_back({key_of(own), own, static_cast<std::int32_t>(centres_.size()), number++});
      }
    };
    with_topology(kind, [&](auto topology) {
      add(decltype(topology)::triangles);
      add(decltype(topology)::quads);
    });
    const auto at = corner_points(mesh_.points, corners);
    centres_.push_back(cell_centre(kind, std::span<const Vec3>(at).first(corners.size())));
  }

  MeasuredFace measured(const Side& behind, const Side* before) const {
    const std::size_t count = behind.corners[3] == no_index ? 3 : 4;
    const auto points = corner_points(mesh_.points, std::span(behind.corners).first(count));
    const auto corners = std::span<const Vec3>(points).first(count);
    const FaceShape shape = face_shape(corners);
    MeasuredFace face{&behind, before, shape.centre, 1, 0.5, face_flatness(corners)};
    if (before == nullptr) return face;
    face.orthogonality = orthogonality(shape, centres_[behind.cell], centres_[before->cell]);
    face.weight = face_weight(shape, centres_[behind.cell], centres_[before->cell]);
    return face;
  }

  const MixedMesh& mesh_;
  std::vector<Side> sides_;
  std::vector<Vec3> centres_;
};

// Counts the values of one measure that are too small.
class Counter {
 public:
  Counter(double best, double limit, std::size_t cells) : limit_(limit), missing_(cells) { count_.worst = best; }

  void add(double value, const Vec3& place, std::initializer_list<const Side*> sides) {
    note(value, place);
    if (!(value < limit_)) return;
    ++count_.misses;
    for (const Side* const side : sides)
      if (side != nullptr) missing_[side->cell] = true;
  }

  void add_cell(double value, const Vec3& place, std::size_t cell) {
    note(value, place);
    if (!(value < limit_)) return;
    ++count_.misses;
    missing_[cell] = true;
  }

  MeasureCount count() const {
    MeasureCount result = count_;
    result.cells = std::ranges::count(missing_, true);
    return result;
  }

 private:
  void note(double value, const Vec3& place) {
    if (value < count_.worst) count_.worst = value, count_.place = place;
  }

  double limit_;
  std::vector<bool> missing_;
  MeasureCount count_;
};

double angle_of(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

MeshMeasures measure_mesh(const MixedMesh& mesh, const MeasureLimits& limits) {
  const Faces faces(mesh);
  const std::size_t cells = mesh.cell_count();
  MeshMeasures result;
  Counter cosine(1, std::cos(limits.angle), cells), weight(0.5, limits.weight, cells),
      determinant(1, limits.determinant, cells), flatness(1, limits.flatness, cells);
  double sum = 0;
  faces.for_each([&](const MeasuredFace& face) {
    ++result.faces;
    flatness.add(face.flatness, face.centre, {face.behind, face.before});
    if (face.before == nullptr) return;
    ++result.inner_faces;
    sum += face.orthogonality;
    cosine.add(face.orthogonality, face.centre, {face.behind, face.before});
    weight.add(face.weight, face.centre, {face.behind, face.before});
  });
  const std::vector<double> determinants = faces.determinants();
  for (std::size_t cell = 0; cell < cells; ++cell)
    determinant.add_cell(determinants[cell], faces.centres()[cell], cell);
  result.angle = cosine.count(), result.weight = weight.count();
  result.determinant = determinant.count(), result.flatness = flatness.count();
  result.angle.worst = angle_of(result.angle.worst);
  if (result.inner_faces > 0) result.mean_angle = angle_of(sum / static_cast<double>(result.inner_faces));
  return result;
}

MeasuresOfCells measure_cells(const MixedMesh& mesh) {
  const Faces faces(mesh);
  const std::size_t cells = mesh.cell_count();
  MeasuresOfCells result{std::vector<double>(cells, 1), std::vector<double>(cells, 0.5), faces.determinants(),
                         std::vector<double>(cells, 1)};
  const auto lower = [](double& least, double value) { least = std::min(least, value); };
  faces.for_each([&](const MeasuredFace& face) {
    for (const Side* const side : {face.behind, face.before}) {
      if (side == nullptr) continue;
      lower(result.orthogonality[side->cell], face.orthogonality);
      lower(result.weight[side->cell], face.weight);
      lower(result.flatness[side->cell], face.flatness);
    }
  });
  return result;
}

}  // namespace hexpipe
