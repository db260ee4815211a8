#include "formats/polyhedra/cell_merging.hpp"

#include <algorithm>
#include <compare>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/mesh/joined_sets.hpp"

namespace hexpipe::polyhedra {
namespace {

// How far the beam search goes.
struct Effort {
  std::size_t cells;  // in a set, at most
  std::size_t beam;   // sets of one size that grow by a cell
  std::size_t sets;   // that are tried, in all
};
constexpr Effort quick{6, 24, 400}, full{12, 48, 1500};
constexpr std::size_t most_near_misses_of_a_size = 3, most_near_misses = 12;

CellSet with(CellSet cells, std::int32_t cell) {
  cells.insert(std::ranges::upper_bound(cells, cell), cell);
  return cells;
}

class Merger {
 public:
  explicit Merger(MeasuredMesh& mesh) : mesh_(mesh) {}

  std::optional<Merge> best(std::span<const std::int32_t> seeds, bool thorough, double most_hexes,
                            std::vector<Merge>& near_misses) {
    const Effort effort = thorough ? full : quick;
    std::vector<CellSet> sets;
    for (const std::int32_t seed : seeds)
      if (is_allowed(seed, most_hexes > 0)) sets.push_back({seed});
    std::set<CellSet> seen;
    for (std::size_t size = 2; size <= effort.cells && seen.size() < effort.sets && !sets.empty(); ++size) {
      std::vector<Merge> tried;
      for (const CellSet& set : sets)
        for (const std::int32_t cell : neighbours_of(set, most_hexes > 0)) {
          CellSet larger = with(set, cell);
          if (!seen.insert(larger).second) continue;
          const auto cost =
              cost_of_change(mesh_, with_neighbours(mesh_, larger), {larger[0]}, [&] { return merge(larger); });
          if (cost) tried.push_back({*cost, std::move(larger)});
        }
      std::ranges::sort(tried);
      for (const Merge& one : tried)
        if (one.cost.wrong_added < 0 && one.cost.wrong_in_new == 0 && one.cost.hex_volume_lost <= most_hexes)
          return one;
      std::ranges::stable_sort(tried, {}, [](const Merge& one) { return std::pair(one.cost.wrong_in_new, one.cost); });
      note_near_misses(tried, most_hexes, near_misses);
      if (tried.size() > effort.beam) tried.resize(effort.beam);
      sets.clear();
      for (Merge& one : tried) sets.push_back(std::move(one.cells));
    }
    return std::nullopt;
  }

  // What merge_cells() says.
  bool merge(const CellSet& set) {
    Groups groups;
    Change change;
    change.whole = set[0];
    if (!gather(set, groups, change)) return false;
    for (const auto& [side, outer] : groups)
      for (const std::vector<Outer>& parts : joined_parts(outer, side.cell))
        if (!add_to_skin(set, side, parts, change)) return false;
    return is_ball(change.skin, change.whole) && apply(set, change);
  }

 private:
  // `tried` is sorted, the sets with the least wrong first.
  static void note_near_misses(const std::vector<Merge>& tried, double most_hexes, std::vector<Merge>& near_misses) {
    for (const Merge& one : std::span(tried).first(std::min(tried.size(), most_near_misses_of_a_size)))
      if (near_misses.size() < most_near_misses && one.cost.wrong_in_new == 1 && one.cost.wrong_added <= 0 &&
          one.cost.hex_volume_lost <= most_hexes)
        near_misses.push_back(one);
  }

  // A face of the skin, and its cell in the set.
  struct Outer {
    std::int32_t face, cell;
  };
  // What faces must have in common to become one: the cell behind them (no_index at the boundary), the surface, and
  // whether the surface's normal points into the set. Without a surface, the last is whether the cell behind owns the
  // face, which keeps some faces apart by chance. Joined all the same, mambo-s27 kept three tets that are wrong, and
  // spot and blub as many as before.
  struct Side {
    std::int32_t cell, surface;
    bool looks_back;
    auto operator<=>(const Side&) const = default;
  };
  using Groups = std::map<Side, std::vector<Outer>>;
  struct Change {
    std::int32_t whole = no_index;
    std::vector<std::int32_t> skin;                            // the polyhedron's faces
    std::vector<std::int32_t> gone;                            // faces inside it, and those that became one
    std::map<std::int32_t, std::vector<std::int32_t>> behind;  // by cell behind it: faces that it loses or gets
  };

  // Sorts the faces of the set into those inside and, by side, those of its skin. False if one inside is on a surface.
  bool gather(const CellSet& set, Groups& groups, Change& change) const {
    for (const std::int32_t cell : set)
      for (const std::int32_t number : mesh_.faces_of(cell)) {
        const PolyhedralMesh::Face& face = mesh_.mesh().faces[number];
        const std::int32_t other = face.other_cell(cell);
        if (other == no_index || !contains(set, other)) {
          const bool looks_back = face.flipped != (face.owner != cell);
          groups[{other, face.surface, looks_back}].push_back({number, cell});
          continue;
        }
        if (face.surface != no_index) return false;
        if (cell == face.owner) change.gone.push_back(number);
      }
    return true;
  }

  // Divides faces of one side into groups that become one face each.
  std::vector<std::vector<Outer>> joined_parts(const std::vector<Outer>& outer, std::int32_t cell_behind) const {
    JoinedSets joined(outer.size());
    for (std::size_t i = 0; i < outer.size(); ++i)
      for (std::size_t k = i + 1; k < outer.size(); ++k)
        if (share_an_edge(outer[i].face, outer[k].face) &&
            (cell_behind != no_index || are_one_facet(outer[i].face, outer[i].cell, outer[k].face, outer[k].cell)))
          joined.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(k));
    std::map<std::int32_t, std::vector<Outer>> parts;
    for (std::size_t i = 0; i < outer.size(); ++i) parts[joined.of(static_cast<std::int32_t>(i))].push_back(outer[i]);
    std::vector<std::vector<Outer>> list;
    for (auto& [first, part] : parts) list.push_back(std::move(part));
    return list;
  }

  // False if the faces together are not a single loop.
  bool add_to_skin(const CellSet& set, const Side& side, const std::vector<Outer>& parts, Change& change) {
    if (parts.size() == 1) {
      const PolyhedralMesh::Face face = mesh_.mesh().faces[parts[0].face];
      const bool owns = contains(set, face.owner);
      mesh_.set_sides(parts[0].face, owns ? change.whole : face.owner, owns ? face.neighbour : change.whole);
      change.skin.push_back(parts[0].face);
      return true;
    }
    std::vector<std::vector<Vertex>> loops;
    for (const Outer& part : parts) loops.push_back(loop_from(mesh_, part.face, part.cell));
    const std::vector<Vertex> loop = loop_around(loops);
    if (loop.empty()) return false;
    const std::int32_t face = mesh_.add_face(loop, change.whole, side.cell, side.surface, side.looks_back);
    mesh_.measure_face(face);
    change.skin.push_back(face);
    for (const Outer& part : parts) change.gone.push_back(part.face);
    if (side.cell == no_index) return true;
    std::vector<std::int32_t>& behind = change.behind[side.cell];
    for (const Outer& part : parts) behind.push_back(part.face);
    behind.push_back(face);
    return true;
  }

  // False if a cell behind would have fewer than four faces.
  bool apply(const CellSet& set, const Change& change) {
    for (const std::int32_t cell : set) mesh_.set_faces(cell, {});
    mesh_.set_faces(change.whole, change.skin);
    mesh_.set_hex(change.whole, false);
    const auto is_in = [](const std::vector<std::int32_t>& faces, std::int32_t face) {
      return std::ranges::find(faces, face) != faces.end();
    };
    for (const auto& [cell, parts] : change.behind) {
      std::vector<std::int32_t> faces;
      for (const std::int32_t face : mesh_.faces_of(cell))
        if (!is_in(parts, face)) faces.push_back(face);
      for (const std::int32_t face : parts)
        if (!is_in(change.gone, face)) faces.push_back(face);
      if (faces.size() < 4) return false;
      mesh_.set_faces(cell, faces);
      mesh_.set_hex(cell, false);
    }
    for (const std::int32_t face : change.gone) mesh_.remove_face(face);
    mesh_.measure_cell(change.whole);
    for (const auto& [cell, parts] : change.behind) mesh_.measure_cell(cell);
    return true;
  }

  bool is_allowed(std::int32_t cell, bool with_hexes) const { return with_hexes || mesh_.mesh().is_hex[cell] == 0; }

  // Cells of the same region behind faces that are on no surface.
  CellSet neighbours_of(const CellSet& set, bool with_hexes) const {
    CellSet found;
    for (const std::int32_t cell : set)
      for (const std::int32_t number : mesh_.faces_of(cell)) {
        const PolyhedralMesh::Face& face = mesh_.mesh().faces[number];
        if (!face.is_inner() || face.surface != no_index) continue;
        const std::int32_t other = face.other_cell(cell);
        if (mesh_.mesh().regions[other] != mesh_.mesh().regions[cell] || contains(set, other) ||
            !is_allowed(other, with_hexes))
          continue;
        found.push_back(other);
      }
    std::ranges::sort(found);
    found.erase(std::ranges::unique(found).begin(), found.end());
    return found;
  }

  bool share_an_edge(std::int32_t one, std::int32_t two) const {
    const auto corners = mesh_.mesh().corners_of(mesh_.mesh().faces[one]);
    return std::ranges::any_of(edges_of(corners),
                               [&](const auto& edge) { return has_edge(mesh_, two, edge.first, edge.second); });
  }

  // Whether two facets of the boundary have no sharp edge between them, and as two faces would make the cell concave.
  bool are_one_facet(std::int32_t one, std::int32_t cell_of_one, std::int32_t two, std::int32_t cell_of_two) const {
    constexpr double clearly = 1e-4;
    const Vec3 a = unit(mesh_.area(one, cell_of_one)), b = unit(mesh_.area(two, cell_of_two));
    if (dot(a, b) < sharp_edge_cosine) return false;
    const Vec3 line = unit(mesh_.shape(two).centre - mesh_.shape(one).centre);
    return dot(line, a) > -clearly || dot(line, b) < clearly;
  }

  // Whether the faces are the skin of a ball: two meet at each edge, in opposite directions, and Euler's number is 2.
  bool is_ball(const std::vector<std::int32_t>& skin, std::int32_t whole) const {
    std::set<std::pair<std::int32_t, std::int32_t>> edges;
    std::set<std::int32_t> vertices;
    for (const std::int32_t face : skin) {
      const std::vector<Vertex> loop = loop_from(mesh_, face, whole);
      for (const auto& [a, b] : edges_of(loop)) {
        vertices.insert(a);
        if (!edges.emplace(a, b).second) return false;
      }
    }
    for (const auto& [a, b] : edges)
      if (!edges.contains({b, a})) return false;
    return vertices.size() + skin.size() == edges.size() / 2 + 2;
  }

  MeasuredMesh& mesh_;
};

}  // namespace

std::optional<Merge> best_merge(MeasuredMesh& mesh, std::span<const std::int32_t> seeds, bool thorough,
                                double most_hexes, std::vector<Merge>& near_misses) {
  near_misses.clear();
  return Merger(mesh).best(seeds, thorough, most_hexes, near_misses);
}

bool merge_cells(MeasuredMesh& mesh, const CellSet& cells) {
  return Merger(mesh).merge(cells);
}

}  // namespace hexpipe::polyhedra
