#include "formats/polyhedra/cell_cutting.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace hexpipe::polyhedra {
namespace {

// How far the middle moves, by the length of its edge. The least is enough between flat faces, warped ones need more.
constexpr std::array<double, 4> depths{1e-3, 1e-2, 0.05, 0.15};

class Cutter {
 public:
  Cutter(MeasuredMesh& mesh, std::int32_t cell) : mesh_(mesh), cell_(cell) {}

  std::optional<Cut> best(double most_hexes) {
    std::optional<Cut> found;
    for (const Cut& way : ways()) {
      const CellSet around = with_neighbours(mesh_, cells_at_edge(way.from, way.to));
      for (const double depth : depths) {
        Cut cut = way;
        cut.depth = depth;
        const auto cost = cost_of_change(mesh_, around, {cell_}, [&] { return make(cut); });
        if (!cost || cost->wrong_added >= 0 || cost->wrong_in_new > 0 || cost->hex_volume_lost > most_hexes) continue;
        if (found && found->cost <= *cost) continue;
        cut.cost = *cost;
        found = cut;
      }
    }
    return found;
  }

  bool make(const Cut& cut) {
    const std::array faces{face_with(cut.from, cut.to), face_with(cut.to, cut.from)};
    if (faces[0] == no_index || faces[1] == no_index) return false;
    const CellSet around = cells_at_edge(cut.from, cut.to);
    const Vertex middle = mesh_.add_point(place_of(cut, faces));
    const std::int32_t other = mesh_.add_cell_after(cell_);
    insert_middle(cut, around, middle);
    std::array<std::int32_t, 2> second{};  // the halves of the two faces that get the cut's end, not its start
    const std::array ends{cut.left, cut.right};
    for (std::size_t i = 0; i < 2; ++i) second[i] = halve(faces[i], middle, ends[i], cut.from);
    divide(cut, faces, second, other);
    add_wall(cut, faces[0], middle, other);
    mesh_.measure_cell(other);
    for (const std::int32_t cell : around) {
      mesh_.set_hex(cell, false);
      mesh_.measure_cell(cell);
    }
    mesh_.set_hex(other, false);
    return true;
  }

 private:
  std::vector<Vertex> loop_of(std::int32_t face) const { return loop_from(mesh_, face, cell_); }

  // The middle becomes a corner of all faces at the edge.
  void insert_middle(const Cut& cut, const CellSet& around, Vertex middle) {
    std::set<std::int32_t> changed;
    for (const std::int32_t cell : around)
      for (const std::int32_t face : mesh_.faces_of(cell))
        if (has_edge(mesh_, face, cut.from, cut.to)) changed.insert(face);
    for (const std::int32_t face : changed) {
      std::vector<Vertex> loop;
      for (const auto& [a, b] : edges_of(mesh_.mesh().corners_of(mesh_.mesh().faces[face]))) {
        loop.push_back(a);
        if ((a == cut.from && b == cut.to) || (a == cut.to && b == cut.from)) loop.push_back(middle);
      }
      mesh_.set_loop(face, loop);
      mesh_.measure_face(face);
    }
  }

  // The face between the two parts. Where it meets the half of a face that the cell keeps, it goes the other way round.
  void add_wall(const Cut& cut, std::int32_t kept_half, Vertex middle, std::int32_t other) {
    const std::vector<Vertex> kept = loop_of(kept_half);
    const auto at = std::ranges::find(kept, middle) - kept.begin();
    const bool goes_left = kept[static_cast<std::size_t>(at + 1) % kept.size()] == cut.left;
    const std::array<Vertex, 3> loop{middle, goes_left ? cut.right : cut.left, goes_left ? cut.left : cut.right};
    const std::int32_t wall = mesh_.add_face(loop, cell_, other, no_index, false);
    mesh_.measure_face(wall);
    add_face_to(cell_, wall), add_face_to(other, wall);
  }

  // The face of the cell that has this edge in this direction, as seen from outside; no_index if there is none.
  std::int32_t face_with(Vertex from, Vertex to) const {
    for (const std::int32_t face : mesh_.faces_of(cell_)) {
      const std::vector<Vertex> loop = loop_of(face);
      for (const auto& [a, b] : edges_of(loop))
        if (a == from && b == to) return face;
    }
    return no_index;
  }

  // All ways to cut the cell: each edge, with each pair of corners of its two faces that an edge of the cell joins.
  std::vector<Cut> ways() const {
    std::vector<std::pair<Vertex, Vertex>> edges;
    for (const std::int32_t face : mesh_.faces_of(cell_)) {
      const std::vector<Vertex> loop = loop_of(face);
      for (const auto& [a, b] : edges_of(loop))
        if (a < b) edges.emplace_back(a, b);
    }
    std::ranges::sort(edges);
    const auto is_edge = [&](Vertex a, Vertex b) {
      return std::ranges::binary_search(edges, std::pair(std::min(a, b), std::max(a, b)));
    };
    std::vector<Cut> found;
    for (const auto& [from, to] : edges) {
      const std::int32_t one = face_with(from, to), two = face_with(to, from);
      if (one == no_index || two == no_index) continue;
      for (const Vertex left : loop_of(one))
        for (const Vertex right : loop_of(two)) {
          const bool is_end = left == from || left == to || right == from || right == to;
          if (is_end || left == right || !is_edge(left, right)) continue;
          found.push_back({.cell = cell_, .from = from, .to = to, .left = left, .right = right});
        }
    }
    return found;
  }

  CellSet cells_at_edge(Vertex a, Vertex b) const {
    return cells_joined_by(mesh_, cell_, [&](std::int32_t face) { return has_edge(mesh_, face, a, b); });
  }

  // The place of the edge's middle: moved away from the cells behind the two faces, and along the boundary.
  Vec3 place_of(const Cut& cut, std::span<const std::int32_t> faces) const {
    const Vec3 &a = mesh_.mesh().points[cut.from], &b = mesh_.mesh().points[cut.to];
    Vec3 way{};
    for (const std::int32_t face : faces)
      if (mesh_.mesh().faces[face].is_inner()) way -= unit(mesh_.area(face, cell_));
    for (const std::int32_t cell : cells_at_edge(cut.from, cut.to))
      for (const std::int32_t face : mesh_.faces_of(cell)) {
        if (mesh_.mesh().faces[face].is_inner() || !has_edge(mesh_, face, cut.from, cut.to)) continue;
        const Vec3 normal = unit(mesh_.shape(face).area);
        way -= normal * dot(way, normal);
      }
    return (a + b) * 0.5 + unit(way) * (cut.depth * norm(b - a));
  }

  // Cuts the face from the middle to the corner `end`. The face keeps the half with the corner `kept`; returns the
  // other.
  std::int32_t halve(std::int32_t face, Vertex middle, Vertex end, Vertex kept) {
    const PolyhedralMesh::Face at = mesh_.mesh().faces[face];
    const auto corners = mesh_.mesh().corners_of(at);
    const std::vector<Vertex> loop(corners.begin(), corners.end());
    const auto place = [&](Vertex v) { return static_cast<std::size_t>(std::ranges::find(loop, v) - loop.begin()); };
    std::vector<Vertex> one = part_of_loop(loop, place(middle), place(end)),
                        two = part_of_loop(loop, place(end), place(middle));
    if (std::ranges::find(one, kept) == one.end()) std::swap(one, two);
    mesh_.set_loop(face, one);
    mesh_.measure_face(face);
    const std::int32_t second = mesh_.add_face(two, at.owner, at.neighbour, at.surface, at.flipped);
    mesh_.measure_face(second);
    if (at.is_inner()) add_face_to(at.other_cell(cell_), second);
    return second;
  }

  void add_face_to(std::int32_t cell, std::int32_t face) {
    std::vector<std::int32_t> faces(mesh_.faces_of(cell).begin(), mesh_.faces_of(cell).end());
    faces.push_back(face);
    mesh_.set_faces(cell, faces);
  }

  // The other cell gets the faces on its side of the cut: the second halves, and all that are joined to them by edges
  // without crossing the cut.
  void divide(const Cut& cut, std::span<const std::int32_t> first, std::span<const std::int32_t> second,
              std::int32_t other) {
    std::vector<std::int32_t> behind(second.begin(), second.end()), rest;
    for (const std::int32_t face : mesh_.faces_of(cell_))
      if (face != first[0] && face != first[1]) rest.push_back(face);
    std::vector<std::int32_t> kept(first.begin(), first.end());
    const auto is_wall = [&](Vertex a, Vertex b) {
      return (a == cut.left && b == cut.right) || (a == cut.right && b == cut.left);
    };
    for (std::size_t i = 0; i < behind.size(); ++i) {
      const std::vector<Vertex> loop = loop_of(behind[i]);
      for (const auto& [a, b] : edges_of(loop)) {
        if (is_wall(a, b)) continue;
        const std::pair back(b, a);
        std::erase_if(rest, [&](std::int32_t face) {
          const std::vector<Vertex> own = loop_of(face);
          const bool joins = std::ranges::any_of(edges_of(own), [&](const auto& edge) { return edge == back; });
          if (joins) behind.push_back(face);
          return joins;
        });
      }
    }
    kept.insert(kept.end(), rest.begin(), rest.end());
    for (const std::int32_t face : behind) {
      const PolyhedralMesh::Face& at = mesh_.mesh().faces[face];
      if (at.owner == cell_)
        mesh_.set_sides(face, other, at.neighbour);
      else
        mesh_.set_sides(face, at.owner, other);
    }
    mesh_.set_faces(cell_, kept);
    mesh_.set_faces(other, behind);
  }

  MeasuredMesh& mesh_;
  std::int32_t cell_;
};

}  // namespace

std::optional<Cut> best_cut(MeasuredMesh& mesh, std::int32_t cell, double most_hexes) {
  return Cutter(mesh, cell).best(most_hexes);
}

bool cut_cell(MeasuredMesh& mesh, const Cut& cut) {
  return Cutter(mesh, cut.cell).make(cut);
}

}  // namespace hexpipe::polyhedra
