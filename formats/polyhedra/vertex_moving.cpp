#include "formats/polyhedra/vertex_moving.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <set>
#include <tuple>
#include <vector>

namespace hexpipe::polyhedra {
namespace {

// By the shortest edge at the vertex.
constexpr std::array<double, 5> lengths{0.02, 0.05, 0.1, 0.2, 0.3};
constexpr double longest_on_curved = 0.1;  // where it leaves the facets of the boundary

class Mover {
 public:
  Mover(MeasuredMesh& mesh, std::int32_t cell, Vertex vertex) : mesh_(mesh), cell_(cell), vertex_(vertex) {
    const auto has_vertex = [&](std::int32_t face) { return has_corner(mesh, face, vertex); };
    cells_ = cells_joined_by(mesh, cell, has_vertex);
    for (const std::int32_t one : cells_)
      std::ranges::copy_if(mesh.faces_of(one), std::inserter(faces_, faces_.end()), has_vertex);
    find_limits();
  }

  std::optional<Move> best() {
    std::optional<Move> found;
    if (limits_.size() > 2) return found;
    const CellSet around = with_neighbours(mesh_, cells_);
    const Vec3 start = mesh_.mesh().points[vertex_];
    const double unit_length = shortest_edge();
    const std::vector<Vec3> all = ways();
    for (const double length : lengths) {
      if (length > longest_) break;
      for (const Vec3& way : all) {
        Move move{.cell = cell_, .vertex = vertex_, .place = start + way * (length * unit_length), .length = length};
        if (trouble_at(move.place, start) > 0) continue;
        const auto worth = worth_of_change(mesh_, around, {cell_}, [&] { return make(move.place); });
        mesh_.set_point(vertex_, start);
        if (!worth || worth->refused >= 0 || worth->own > 0) continue;
        if (found && found->worth <= *worth) continue;
        move.worth = *worth;
        found = move;
      }
      if (found) return found;
    }
    return found;
  }

  // Calls visit(place, trouble of the cell with its vertex there).
  template <class Visit>
  void for_each_place(Visit&& visit) {
    if (limits_.size() > 2) return;
    const Vec3 start = mesh_.mesh().points[vertex_];
    const double unit_length = shortest_edge();
    const std::vector<Vec3> all = ways();
    for (const double length : lengths) {
      if (length > longest_) break;
      for (const Vec3& way : all) {
        const Vec3 place = start + way * (length * unit_length);
        visit(place, trouble_at(place, start));
      }
    }
  }

  std::optional<Worth> worth_at(const Vec3& place) {
    const Vec3 start = mesh_.mesh().points[vertex_];
    const auto worth = worth_of_change(mesh_, with_neighbours(mesh_, cells_), {cell_}, [&] { return make(place); });
    mesh_.set_point(vertex_, start);
    return worth;
  }

  bool make(const Vec3& place) {
    mesh_.set_point(vertex_, place);
    for (const std::int32_t face : faces_) mesh_.measure_face(face);
    for (const std::int32_t cell : cells_) mesh_.measure_cell(cell);
    return true;
  }

 private:
  double shortest_edge() const {
    double shortest = -1;
    for (const std::int32_t face : faces_) {
      const auto corners = mesh_.mesh().corners_of(mesh_.mesh().faces[face]);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vertex a = corners[i], b = corners[(i + 1) % corners.size()];
        if (a != vertex_ && b != vertex_) continue;
        const double length = norm(mesh_.mesh().points[a] - mesh_.mesh().points[b]);
        if (shortest < 0 || length < shortest) shortest = length;
      }
    }
    return shortest;
  }

  // Of the cell itself with its vertex there: a quick test.
  double trouble_at(const Vec3& place, const Vec3& start) {
    MeasuredMesh::Undo undo(mesh_, std::array{cell_});
    mesh_.set_point(vertex_, place);
    for (const std::int32_t face : mesh_.faces_of(cell_))
      if (faces_.contains(face)) mesh_.measure_face(face);
    mesh_.measure_cell(cell_);
    const double trouble = mesh_.trouble(cell_);
    undo.take_back();
    mesh_.set_point(vertex_, start);
    return trouble;
  }

  // The normals of the cell's faces, both ways, and those between two of them.
  std::vector<Vec3> ways() const {
    std::vector<Vec3> normals;
    for (const std::int32_t face : mesh_.faces_of(cell_)) normals.push_back(unit(mesh_.area(face, cell_)));
    std::vector<Vec3> found;
    for (const Vec3& one : normals)
      for (const double sign : {1.0, -1.0}) found.push_back(one * sign);
    constexpr std::size_t few = 8;  // more have normals in many directions
    for (std::size_t i = 0; i < std::min(normals.size(), few); ++i)
      for (std::size_t k = 0; k < i; ++k)
        for (const double sign : {1.0, -1.0}) {
          found.push_back(unit(normals[i] + normals[k] * sign));
          found.push_back(-found.back());
        }
    for (Vec3& way : found) {
      for (const Vec3& limit : limits_) way -= limit * dot(way, limit);
      way = unit(way);
    }
    std::erase_if(found, [](const Vec3& way) { return norm_squared(way) < 0.5; });
    return found;
  }

  // The directions in which the vertex must not move: the normal where the boundary is smooth around it, two where it
  // has an edge or two surfaces meet, three elsewhere.
  void find_limits() {
    std::set<std::int32_t> surfaces;
    std::vector<Vec3> areas;
    for (const std::int32_t number : faces_) {
      const PolyhedralMesh::Face& face = mesh_.mesh().faces[number];
      if (face.is_inner() && face.surface == no_index) continue;
      surfaces.insert(face.surface);
      areas.push_back(mesh_.shape(number).area);
    }
    constexpr double flat = 1e-3, smooth = 0.34;  // sines; that of 20 degrees
    std::ranges::sort(areas, std::greater<>(), norm_squared);
    for (const Vec3& area : areas) {
      Vec3 rest = unit(area);
      for (const Vec3& limit : limits_) rest -= limit * dot(rest, limit);
      if (norm(rest) > smooth)
        limits_.push_back(unit(rest));
      else if (norm(rest) > flat)
        longest_ = longest_on_curved;
    }
    // The border between two surfaces in one plane must stay.
    if (surfaces.size() > limits_.size()) limits_.resize(3);
  }

  MeasuredMesh& mesh_;
  std::int32_t cell_;
  Vertex vertex_;
  CellSet cells_;  // that have the vertex
  std::set<std::int32_t> faces_;
  std::vector<Vec3> limits_;
  double longest_ = lengths.back();
};

std::set<Vertex> vertices_of(const MeasuredMesh& mesh, std::int32_t cell) {
  std::set<Vertex> vertices;
  for (const std::int32_t face : mesh.faces_of(cell))
    for (const Vertex v : mesh.mesh().corners_of(mesh.mesh().faces[face])) vertices.insert(v);
  return vertices;
}

}  // namespace

std::optional<Move> best_move(MeasuredMesh& mesh, std::int32_t cell) {
  std::optional<Move> found;
  for (const Vertex vertex : vertices_of(mesh, cell)) {
    const auto move = Mover(mesh, cell, vertex).best();
    if (move && (!found || std::tie(move->worth, move->length) < std::tie(found->worth, found->length))) found = move;
  }
  return found;
}

std::int64_t climb(MeasuredMesh& mesh, std::int32_t cell, std::int64_t refused_before, ClimbEffort effort) {
  struct Step {
    double trouble;
    Vertex vertex;
    Vec3 place;
  };
  std::vector<Step> made;  // with the places before
  std::int64_t refused = refused_before;
  double trouble = mesh.trouble(cell);
  for (int step = 0; step < effort.steps && trouble > 0; ++step) {
    std::vector<Step> steps;
    for (const Vertex vertex : vertices_of(mesh, cell))
      Mover(mesh, cell, vertex).for_each_place([&](const Vec3& place, double there) {
        if (there < 0.95 * trouble) steps.push_back({there, vertex, place});
      });
    std::ranges::stable_sort(steps, {}, &Step::trouble);
    if (steps.size() > effort.tried) steps.resize(effort.tried);
    bool found = false;
    for (const Step& one : steps) {
      Mover mover(mesh, cell, one.vertex);
      const auto worth = mover.worth_at(one.place);
      if (!worth || worth->refused > 0) continue;
      made.push_back({trouble, one.vertex, mesh.mesh().points[one.vertex]});
      mover.make(one.place);
      refused += worth->refused;
      trouble = mesh.trouble(cell);
      found = true;
      break;
    }
    if (!found) break;
  }
  if (trouble == 0 && refused < 0) return static_cast<std::int64_t>(made.size());
  for (; !made.empty(); made.pop_back()) Mover(mesh, cell, made.back().vertex).make(made.back().place);
  return 0;
}

bool move_vertex(MeasuredMesh& mesh, const Move& move) {
  return Mover(mesh, move.cell, move.vertex).make(move.place);
}

}  // namespace hexpipe::polyhedra
