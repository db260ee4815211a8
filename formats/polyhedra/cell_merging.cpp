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

// How far sets are tried: cells in a set, sets of a size that get another cell, and sets in all.
struct Effort {
  std::size_t cells, beam, sets;
};
constexpr Effort quick{6, 24, 400}, full{12, 48, 1500};
// So many of each size go to `nearly`, and so many in all.
constexpr std::size_t most_nearly = 3, most_nearly_in_all = 12;

CellSet with(CellSet cells, std::int32_t cell) {
  cells.insert(std::ranges::upper_bound(cells, cell), cell);
  return cells;
}

class Merger {
 public:
  explicit Merger(MeasuredMesh& mesh) : mesh_(mesh) {}

  std::optional<Merge> best(std::span<const std::int32_t> seeds, bool thorough, double most_hexes,
                            std::vector<Merge>& nearly) {
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
          const auto worth =
              worth_of_change(mesh_, with_neighbours(mesh_, larger), {larger[0]}, [&] { return merge(larger); });
          if (worth) tried.push_back({*worth, std::move(larger)});
        }
      std::ranges::sort(tried);
      for (const Merge& one : tried)
        if (one.worth.refused < 0 && one.worth.own == 0 && one.worth.hex_volume <= most_hexes) return one;
      std::ranges::stable_sort(tried, {}, [](const Merge& one) { return std::pair(one.worth.own, one.worth); });
      for (std::size_t i = 0; i < std::min(tried.size(), most_nearly) && nearly.size() < most_nearly_in_all; ++i)
        if (tried[i].worth.own == 1 && tried[i].worth.refused <= 0 && tried[i].worth.hex_volume <= most_hexes)
          nearly.push_back(tried[i]);
      if (tried.size() > effort.beam) tried.resize(effort.beam);
      sets.clear();
      for (Merge& one : tried) sets.push_back(std::move(one.cells));
    }
    return std::nullopt;
  }

  // The first cell of the set becomes the polyhedron, the others are gone. False if it is not a ball with a simple
  // skin; then the mesh is half changed.
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
  // A face of the skin, and its cell in the set.
  struct Outer {
    std::int32_t face, cell;
  };
  // Where faces may be one: the cell behind, or none, the surface, and whether its facets look into the set. Without a
  // surface, that is whether the cell behind has the lower number: this keeps some faces apart by chance. With all of
  // them joined, mambo-s27 kept three tets, and spot and blub as many as before.
  struct Side {
    std::int32_t cell, surface;
    bool looks_back;
    auto operator<=>(const Side&) const = default;
  };
  using Groups = std::map<Side, std::vector<Outer>>;
  struct Change {
    std::int32_t whole = no_index;
    std::vector<std::int32_t> skin, gone;                      // faces
    std::map<std::int32_t, std::vector<std::int32_t>> behind;  // by cell: faces that it loses, and gets
  };

  // False if a surface is inside.
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

  // The faces that become one each.
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

  // Cells behind faces on no surface, in the same region.
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
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (has_edge(mesh_, two, corners[i], corners[(i + 1) % corners.size()])) return true;
    return false;
  }

  // Whether two facets of the boundary are as good as flat together, and would make a cell concave as two.
  bool are_one_facet(std::int32_t one, std::int32_t cell_of_one, std::int32_t two, std::int32_t cell_of_two) const {
    constexpr double cosine_of_40 = 0.766, clearly = 1e-4;
    const Vec3 a = unit(mesh_.area(one, cell_of_one)), b = unit(mesh_.area(two, cell_of_two));
    if (dot(a, b) < cosine_of_40) return false;
    const Vec3 line = unit(mesh_.shape(two).centre - mesh_.shape(one).centre);
    return dot(line, a) > -clearly || dot(line, b) < clearly;
  }

  // Whether the faces close around a ball: each edge has two of them, in both directions, and Euler's number is 2.
  bool is_ball(const std::vector<std::int32_t>& skin, std::int32_t whole) const {
    std::set<std::pair<std::int32_t, std::int32_t>> edges;
    std::set<std::int32_t> vertices;
    for (const std::int32_t face : skin) {
      const std::vector<Vertex> loop = loop_from(mesh_, face, whole);
      for (std::size_t i = 0; i < loop.size(); ++i) {
        vertices.insert(loop[i]);
        if (!edges.emplace(loop[i], loop[(i + 1) % loop.size()]).second) return false;
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
                                double most_hexes, std::vector<Merge>& nearly) {
  nearly.clear();
  return Merger(mesh).best(seeds, thorough, most_hexes, nearly);
}

bool merge_cells(MeasuredMesh& mesh, const CellSet& cells) {
  return Merger(mesh).merge(cells);
}

}  // namespace hexpipe::polyhedra
