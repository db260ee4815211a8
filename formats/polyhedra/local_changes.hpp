#pragma once
// What all changes share: sets of cells, loops of faces, and what a change costs, found by making it and undoing it.

#include <algorithm>
#include <compare>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "formats/polyhedra/measured_mesh.hpp"

namespace hexpipe::polyhedra {

using CellSet = std::vector<std::int32_t>;  // in ascending order

inline bool contains(const CellSet& cells, std::int32_t cell) {
  return std::ranges::binary_search(cells, cell);
}

// These cells, and all that share a face with one of them.
CellSet with_neighbours(const MeasuredMesh& mesh, const CellSet& cells);

// A face's corners, counter-clockwise as seen from outside the cell.
std::vector<Vertex> loop_from(const MeasuredMesh& mesh, std::int32_t face, std::int32_t cell);

// The outline of some faces, all given as loops of the same sense: what is left of their edges when those that two
// faces share are gone. Empty if that is not one loop that passes each corner once.
std::vector<Vertex> loop_around(const std::vector<std::vector<Vertex>>& faces);

// The corners of a loop from one position to another, both included.
std::vector<Vertex> part_of_loop(const std::vector<Vertex>& loop, std::size_t first, std::size_t last);

bool has_corner(const MeasuredMesh& mesh, std::int32_t face, Vertex vertex);
bool has_edge(const MeasuredMesh& mesh, std::int32_t face, Vertex a, Vertex b);

// The cell, and all that can be reached from it through faces for which holds(face) is true.
template <class Holds>
CellSet cells_joined_by(const MeasuredMesh& mesh, std::int32_t cell, Holds&& holds) {
  CellSet found;
  std::vector<std::int32_t> next{cell};
  while (!next.empty()) {
    const std::int32_t at = next.back();
    next.pop_back();
    if (contains(found, at)) continue;
    found.insert(std::ranges::upper_bound(found, at), at);
    for (const std::int32_t face : mesh.faces_of(at))
      if (mesh.mesh().faces[face].is_inner() && holds(face)) next.push_back(mesh.mesh().faces[face].other_cell(at));
  }
  return found;
}

// A surface that turns by more than 40 degrees at an edge has a sharp edge there, which no change may remove.
inline constexpr double sharp_edge_cosine = 0.766;

// What a change costs. Compared field by field in this order; less is better.
struct Cost {
  std::int64_t wrong_added = 0;   // cells and faces with something wrong, after less before: negative if it helps
  double hex_volume_lost = 0;     // of hexes that become polyhedra
  std::int64_t severe_added = 0;  // faces over 70 degrees, after less before
  std::int64_t wrong_in_new = 0;  // new cells and faces of them with something wrong
  auto operator<=>(const Cost&) const = default;
};

struct RefusalCount {
  std::int64_t wrong = 0, severe = 0;
};
// Over the cells and their faces, each counted once.
RefusalCount count_refusals(const MeasuredMesh& mesh, const CellSet& cells);

// Remembers the hexes among some cells, to tell how much volume of them a change takes.
class HexVolumes {
 public:
  HexVolumes(const MeasuredMesh& mesh, const CellSet& cells) {
    for (const std::int32_t cell : cells)
      if (mesh.mesh().is_hex[cell] != 0) hexes_.emplace_back(cell, mesh.volume(cell));
  }
  // The volume of those that are no longer hexes.
  double volume_lost(const MeasuredMesh& mesh) const {
    double lost = 0;
    for (const auto& [cell, volume] : hexes_)
      if (!mesh.is_alive(cell) || mesh.mesh().is_hex[cell] == 0) lost += volume;
    return lost;
  }

 private:
  std::vector<std::pair<std::int32_t, double>> hexes_;
};

// What change() costs: makes it, counts, and undoes it, but for points that it moved. `cells` must hold all cells whose
// faces it changes, and their neighbours. `made` are those of `cells` that count as new; cells that it adds do, too.
// nullopt if change() returns false, which means that it cannot be made.
template <class Change>
std::optional<Cost> cost_of_change(MeasuredMesh& mesh, const CellSet& cells, CellSet made, Change&& change) {
  MeasuredMesh::Undo undo(mesh, cells);
  const RefusalCount before = count_refusals(mesh, cells);
  const HexVolumes hexes(mesh, cells);
  const auto first_added = static_cast<std::int32_t>(mesh.cell_count());
  std::optional<Cost> result;
  if (change()) {
    CellSet all = cells;
    for (auto cell = first_added; cell < static_cast<std::int32_t>(mesh.cell_count()); ++cell)
      all.push_back(cell), made.push_back(cell);
    const RefusalCount after = count_refusals(mesh, all);
    result = {.wrong_added = after.wrong - before.wrong,
              .hex_volume_lost = hexes.volume_lost(mesh),
              .severe_added = after.severe - before.severe,
              .wrong_in_new = count_refusals(mesh, made).wrong};
  }
  undo.take_back();
  return result;
}

}  // namespace hexpipe::polyhedra
