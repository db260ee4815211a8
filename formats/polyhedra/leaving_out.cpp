#include "formats/polyhedra/leaving_out.hpp"

#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace hexpipe::polyhedra {
namespace {

// The height of a flat cell, by the mean length of the edges around its facets. Two equilateral triangles that meet at
// an angle of 27 degrees reach it.
constexpr double most_height = 0.2;
// Of the angle between the facets that go and those that come: 35 degrees.
constexpr double most_turn_cosine = 0.819;

class Leaver {
 public:
  Leaver(MeasuredMesh& mesh, std::int32_t cell) : mesh_(mesh), cell_(cell) {
    for (const std::int32_t face : mesh.faces_of(cell)) (at(face).is_inner() ? inner_ : facets_).push_back(face);
  }

  std::optional<Cost> cost() {
    if (!is_allowed() || !is_flat()) return std::nullopt;
    return cost_of_change(mesh_, with_neighbours(mesh_, {cell_}), {}, [&] { return make(); });
  }

  bool make() {
    if (!are_disk(facets_) || !are_disk(inner_)) return false;
    const std::int32_t surface = at(facets_[0]).surface;
    const bool flipped = at(facets_[0]).flipped;
    for (const std::int32_t face : inner_) {
      const std::int32_t behind = at(face).other_cell(cell_);
      mesh_.set_loop(face, loop_from(mesh_, face, behind));
      mesh_.set_sides(face, behind, no_index);
      mesh_.set_surface(face, surface, flipped);
      mesh_.measure_face(face);
    }
    for (const std::int32_t face : facets_) mesh_.remove_face(face);
    mesh_.set_faces(cell_, {});
    // Their shapes stay the same, but measuring notes them as changed, so that refused_after() judges them again.
    for (const std::int32_t face : inner_) mesh_.measure_cell(at(face).owner);
    return true;
  }

 private:
  const PolyhedralMesh::Face& at(std::int32_t face) const { return mesh_.mesh().faces[face]; }

  bool is_allowed() const {
    if (mesh_.mesh().is_hex[cell_] != 0 || facets_.size() < 2 || inner_.empty()) return false;
    for (const std::int32_t face : facets_)
      if (at(face).surface != at(facets_[0]).surface || at(face).flipped != at(facets_[0]).flipped) return false;
    for (const std::int32_t face : inner_)
      if (at(face).surface != no_index ||
          mesh_.mesh().regions[at(face).other_cell(cell_)] != mesh_.mesh().regions[cell_])
        return false;
    return stays_manifold() && cells_stay_joined();
  }

  // Three times the volume by the area of the facets is the height. For a tet with three facets this is its height over
  // the fourth face; with two, the distance between the edge of the boundary that goes and the one that comes.
  bool is_flat() const {
    Vec3 area{};
    for (const std::int32_t face : facets_) area += mesh_.area(face, cell_);
    const std::vector<Vertex> loop = loop_around(loops_of(facets_));
    if (loop.empty()) return false;
    double length = 0;
    for (const auto& [a, b] : edges_of(loop)) length += norm(mesh_.mesh().points[a] - mesh_.mesh().points[b]);
    length /= static_cast<double>(loop.size());
    if (3 * mesh_.volume(cell_) > most_height * length * norm(area)) return false;
    const Vec3 normal = unit(area);
    for (const std::int32_t face : facets_)
      for (const std::int32_t other : facets_)
        if (dot(unit(mesh_.area(face, cell_)), unit(mesh_.area(other, cell_))) < sharp_edge_cosine) return false;
    for (const std::int32_t face : inner_)
      if (-dot(unit(mesh_.area(face, cell_)), normal) < most_turn_cosine) return false;
    return true;
  }

  // Edges and vertices between the faces that become facets must lie inside and on no surface now: otherwise the
  // boundary would touch itself there.
  bool stays_manifold() const {
    const std::vector<Vertex> loop = loop_around(loops_of(facets_));
    const std::set<Vertex> rim(loop.begin(), loop.end());
    std::set<std::pair<Vertex, Vertex>> outline;
    for (const auto& [a, b] : edges_of(loop)) outline.emplace(a, b);
    const auto is_inside = [&](auto&& holds) {
      for (const std::int32_t cell : cells_joined_by(mesh_, cell_, holds))
        for (const std::int32_t face : mesh_.faces_of(cell))
          if (holds(face) && (!at(face).is_inner() || at(face).surface != no_index)) return false;
      return true;
    };
    for (const std::vector<Vertex>& face : loops_of(inner_))
      for (const auto& edge : edges_of(face)) {
        const Vertex a = edge.first, b = edge.second;
        // The outline goes round the facets, against these faces.
        if (!outline.contains({b, a}) && !is_inside([&](std::int32_t number) { return has_edge(mesh_, number, a, b); }))
          return false;
        if (!rim.contains(a) && !is_inside([&](std::int32_t number) { return has_corner(mesh_, number, a); }))
          return false;
      }
    return true;
  }

  // Each cell behind keeps a neighbour.
  bool cells_stay_joined() const {
    for (const std::int32_t face : inner_) {
      const std::int32_t behind = at(face).other_cell(cell_);
      bool is_joined = false;
      for (const std::int32_t other : mesh_.faces_of(behind))
        is_joined |= at(other).is_inner() && at(other).other_cell(behind) != cell_;
      if (!is_joined) return false;
    }
    return true;
  }

  std::vector<std::vector<Vertex>> loops_of(const std::vector<std::int32_t>& faces) const {
    std::vector<std::vector<Vertex>> loops;
    for (const std::int32_t face : faces) loops.push_back(loop_from(mesh_, face, cell_));
    return loops;
  }

  bool are_disk(const std::vector<std::int32_t>& faces) const { return !loop_around(loops_of(faces)).empty(); }

  MeasuredMesh& mesh_;
  std::int32_t cell_;
  std::vector<std::int32_t> facets_, inner_;
};

}  // namespace

std::optional<Cost> cost_of_leaving_out(MeasuredMesh& mesh, std::int32_t cell) {
  return Leaver(mesh, cell).cost();
}

bool leave_out(MeasuredMesh& mesh, std::int32_t cell) {
  return Leaver(mesh, cell).make();
}

}  // namespace hexpipe::polyhedra
