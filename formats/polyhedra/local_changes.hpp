#pragma once
// What a change of a few cells is worth, found by making it and taking it back.

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

CellSet with_neighbours(const MeasuredMesh& mesh, const CellSet& cells);

// A face's corners, counter-clockwise as seen from outside the cell.
std::vector<Vertex> loop_from(const MeasuredMesh& mesh, std::int32_t face, std::int32_t cell);

// The loop around faces that meet at edges, which are loops themselves with the same sense; empty if there are several,
// or one that passes a corner twice.
std::vector<Vertex> loop_around(const std::vector<std::vector<Vertex>>& faces);

// The corners of a loop from one place to another, both included.
std::vector<Vertex> part_of_loop(const std::vector<Vertex>& loop, std::size_t first, std::size_t last);

bool has_corner(const MeasuredMesh& mesh, std::int32_t face, Vertex vertex);
bool has_edge(const MeasuredMesh& mesh, std::int32_t face, Vertex a, Vertex b);

// The cell, and those that are joined to it by faces for which holds(face).
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

// Compared in this order, less is better.
struct Worth {
  std::int64_t refused = 0;  // cells and faces with something wrong more than before
  double hex_volume = 0;     // of hexes that become polyhedra
  std::int64_t severe = 0;   // faces over 70 degrees more than before
  std::int64_t own = 0;      // what is wrong with the new cells and their faces
  auto operator<=>(const Worth&) const = default;
};

struct RefusalCount {
  std::int64_t wrong = 0, severe = 0;
};
// Of cells and their faces, each once.
RefusalCount count_refusals(const MeasuredMesh& mesh, const CellSet& cells);

// The hexes among some cells, with their volumes.
class Hexes {
 public:
  Hexes(const MeasuredMesh& mesh, const CellSet& cells) {
    for (const std::int32_t cell : cells)
      if (mesh.mesh().is_hex[cell] != 0) hexes_.emplace_back(cell, mesh.volume(cell));
  }
  // The volume of those that are hexes no more.
  double volume_lost(const MeasuredMesh& mesh) const {
    double lost = 0;
    for (const auto& [cell, volume] : hexes_)
      if (!mesh.is_alive(cell) || mesh.mesh().is_hex[cell] == 0) lost += volume;
    return lost;
  }

 private:
  std::vector<std::pair<std::int32_t, double>> hexes_;
};

// Makes the change and takes it back. `cells` has all that it touches: those whose faces it changes and those beside
// them. `made` are the new cells among them, or cells that are added. Nothing if change() returns false.
template <class Change>
std::optional<Worth> worth_of_change(MeasuredMesh& mesh, const CellSet& cells, CellSet made, Change&& change) {
  MeasuredMesh::Undo undo(mesh, cells);
  const RefusalCount before = count_refusals(mesh, cells);
  const Hexes hexes(mesh, cells);
  const auto first_added = static_cast<std::int32_t>(mesh.cell_count());
  std::optional<Worth> result;
  if (change()) {
    CellSet all = cells;
    for (auto cell = first_added; cell < static_cast<std::int32_t>(mesh.cell_count()); ++cell)
      all.push_back(cell), made.push_back(cell);
    const RefusalCount after = count_refusals(mesh, all);
    result = {.refused = after.wrong - before.wrong,
              .hex_volume = hexes.volume_lost(mesh),
              .severe = after.severe - before.severe,
              .own = count_refusals(mesh, made).wrong};
  }
  undo.take_back();
  return result;
}

}  // namespace hexpipe::polyhedra
