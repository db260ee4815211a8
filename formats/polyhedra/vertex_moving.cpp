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

// How far a vertex is moved, by the shortest edge at it.
constexpr std::array<double, 5> lengths{0.02, 0.05, 0.1, 0.2, 0.3};
constexpr double longest_on_curved = 0.1;  // on a curved boundary, whose facets it leaves

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
    const std::vector<Place> all = places();
    if (all.empty()) return found;
    const CellSet around = with_neighbours(mesh_, cells_);
    for (const Place& at : all) {
      if (found && at.length > found->length) break;
      if (trouble_at(at.point) > 0) continue;
      const auto cost = cost_around(around, at.point);
      if (!cost || cost->wrong_added >= 0 || cost->wrong_in_new > 0) continue;
      if (found && found->cost <= *cost) continue;
      found = {.cost = *cost, .cell = cell_, .vertex = vertex_, .place = at.point, .length = at.length};
    }
    return found;
  }

  // Calls visit(place, trouble of the cell with its vertex there).
  template <class Visit>
  void for_each_place(Visit&& visit) {
    for (const Place& at : places()) visit(at.point, trouble_at(at.point));
  }

  std::optional<Cost> cost_at(const Vec3& place) { return cost_around(with_neighbours(mesh_, cells_), place); }

  void move_to(const Vec3& place) {
    mesh_.set_point(vertex_, place);
    for (const std::int32_t face : faces_) mesh_.measure_face(face);
    for (const std::int32_t cell : cells_) mesh_.measure_cell(cell);
  }

 private:
  struct Place {
    double length;  // of the way, by the shortest edge at the vertex
    Vec3 point;
  };

  // Where the vertex may go, short ways first; none if it may not move at all.
  std::vector<Place> places() const {
    std::vector<Place> found;
    if (limits_.size() > 2) return found;
    const Vec3 start = mesh_.mesh().points[vertex_];
    const double unit_length = shortest_edge();
    const std::vector<Vec3> all = ways();
    for (const double length : lengths) {
      if (length > longest_) break;
      for (const Vec3& way : all) found.push_back({length, start + way * (length * unit_length)});
    }
    return found;
  }

  std::optional<Cost> cost_around(const CellSet& around, const Vec3& place) {
    const Vec3 start = mesh_.mesh().points[vertex_];
    const auto cost = cost_of_change(mesh_, around, {cell_}, [&] { return move_to(place), true; });
    mesh_.set_point(vertex_, start);
    return cost;
  }

  double shortest_edge() const {
    double shortest = -1;
    for (const std::int32_t face : faces_) {
      for (const auto& [a, b] : edges_of(mesh_.mesh().corners_of(mesh_.mesh().faces[face]))) {
        if (a != vertex_ && b != vertex_) continue;
        const double length = norm(mesh_.mesh().points[a] - mesh_.mesh().points[b]);
        if (shortest < 0 || length < shortest) shortest = length;
      }
    }
    return shortest;
  }

  // The trouble of the cell with its vertex there. Measures this cell alone, so it is much quicker than the cost.
  double trouble_at(const Vec3& place) {
    const Vec3 start = mesh_.mesh().points[vertex_];
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

  // Directions: the normals of the cell's faces and the bisectors of two of them, both ways, as far as the limits
  // allow.
  std::vector<Vec3> ways() const {
    std::vector<Vec3> normals;
    for (const std::int32_t face : mesh_.faces_of(cell_)) normals.push_back(unit(mesh_.area(face, cell_)));
    std::vector<Vec3> found;
    for (const Vec3& one : normals)
      for (const double sign : {1.0, -1.0}) found.push_back(one * sign);
    constexpr std::size_t few = 8;  // the normals of more faces are directions enough
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
    // Those of which the limits leave nothing are 0.
    std::erase_if(found, [](const Vec3& way) { return norm_squared(way) < 0.5; });
    return found;
  }

  // The directions in which the vertex must not move: none inside, the normal where the boundary is smooth around it,
  // two along a straight edge of the boundary, three (it stays) at its corners. A border between two surfaces counts as
  // an edge.
  void find_limits() {
    std::set<std::int32_t> surfaces;
    std::vector<Vec3> areas;
    for (const std::int32_t number : faces_) {
      const PolyhedralMesh::Face& face = mesh_.mesh().faces[number];
      if (face.is_inner() && face.surface == no_index) continue;
      surfaces.insert(face.surface);
      areas.push_back(mesh_.shape(number).area);
    }
    constexpr double flat = 1e-3, smooth = 0.34;  // sines: of rounding, and of 20 degrees
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
  CellSet cells_;                 // all cells at the vertex
  std::set<std::int32_t> faces_;  // all faces at the vertex
  std::vector<Vec3> limits_;      // orthonormal
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
    if (move && (!found || std::tie(move->cost, move->length) < std::tie(found->cost, found->length))) found = move;
  }
  return found;
}

std::int64_t climb(MeasuredMesh& mesh, std::int32_t cell, std::int64_t wrong_added, ClimbEffort effort) {
  struct Step {
    double trouble;
    Vertex vertex;
    Vec3 place;
  };
  constexpr double enough_less = 0.95;  // a step of 0.98 leaves less, but takes half as long again
  std::vector<Step> made;               // with the places before, to take them back
  double trouble = mesh.trouble(cell);
  for (int step = 0; step < effort.steps && trouble > 0; ++step) {
    std::vector<Step> steps;
    for (const Vertex vertex : vertices_of(mesh, cell))
      Mover(mesh, cell, vertex).for_each_place([&](const Vec3& place, double there) {
        if (there < enough_less * trouble) steps.push_back({there, vertex, place});
      });
    std::ranges::stable_sort(steps, {}, &Step::trouble);
    if (steps.size() > effort.tried) steps.resize(effort.tried);
    bool found = false;
    for (const Step& one : steps) {
      Mover mover(mesh, cell, one.vertex);
      const auto cost = mover.cost_at(one.place);
      if (!cost || cost->wrong_added > 0) continue;
      made.push_back({trouble, one.vertex, mesh.mesh().points[one.vertex]});
      mover.move_to(one.place);
      wrong_added += cost->wrong_added;
      trouble = mesh.trouble(cell);
      found = true;
      break;
    }
    if (!found) break;
  }
  if (trouble == 0 && wrong_added < 0) return static_cast<std::int64_t>(made.size());
  for (; !made.empty(); made.pop_back()) Mover(mesh, cell, made.back().vertex).move_to(made.back().place);
  return 0;
}

void move_vertex(MeasuredMesh& mesh, const Move& move) {
  Mover(mesh, move.cell, move.vertex).move_to(move.place);
}

}  // namespace hexpipe::polyhedra
