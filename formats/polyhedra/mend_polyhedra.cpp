#include "formats/polyhedra/mend_polyhedra.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "formats/polyhedra/cell_cutting.hpp"
#include "formats/polyhedra/cell_merging.hpp"
#include "formats/polyhedra/vertex_moving.hpp"

namespace hexpipe::polyhedra {
namespace {

// Mends one cell or face after the other.
class Mender {
 public:
  Mender(MeasuredMesh& mesh, double most_hexes, MendCounts& counts)
      : mesh_(mesh), hexes_left_(most_hexes), counts_(counts) {}

  // Returns what is left.
  MeasuredMesh::Refused run(MeasuredMesh::Refused refused) {
    for (const auto& [thorough, with_hexes] :
         {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
      if (refused.none()) break;
      pass(refused, thorough, with_hexes ? hexes_left_ : 0);
      refused = mesh_.refused_after(refused);
    }
    return refused;
  }

 private:
  void pass(const MeasuredMesh::Refused& refused, bool thorough, double most) {
    for (const std::int32_t cell : refused.cells)
      if (mesh_.is_alive(cell) && (mesh_.refusals_of_cell(cell) & wrong) != 0) mend(std::array{cell}, thorough, most);
    for (const std::int32_t number : refused.faces) {
      const PolyhedralMesh::Face face = mesh_.mesh().faces[number];
      if (face.owner == no_index || (mesh_.refusals_of_face(number) & wrong) == 0) continue;
      const std::array cells{face.owner, face.neighbour};
      mend(std::span(cells).first(face.is_inner() ? 2 : 1), thorough, most);
    }
  }

  // Cells of which one is wrong, or whose face is. The least change goes first.
  void mend(std::span<const std::int32_t> cells, bool thorough, double most) {
    most = std::min(most, hexes_left_);
    if (move(cells)) return;
    std::vector<Merge> nearly;
    const std::optional<Merge> merge = best_merge(mesh_, cells, thorough, most, nearly);
    if (merge && merge->worth.hex_volume == 0) return keep(*merge);
    std::optional<Cut> cut;
    for (const std::int32_t cell : cells) {
      const auto one = best_cut(mesh_, cell, most);
      if (one && (!cut || one->worth < cut->worth)) cut = one;
    }
    if (cut && (!merge || cut->worth.hex_volume < merge->worth.hex_volume)) return keep(*cut);
    if (merge) return keep(*merge);
    if (!climb_alone(cells)) merge_and_climb(nearly);
  }

  bool move(std::span<const std::int32_t> cells) {
    std::optional<Move> best;
    for (const std::int32_t cell : cells) {
      const auto one = best_move(mesh_, cell);
      if (one && (!best || one->worth < best->worth)) best = one;
    }
    if (!best) return false;
    ++counts_.moved;
    move_vertex(mesh_, *best);
    return true;
  }

  bool climb_alone(std::span<const std::int32_t> cells) {
    for (const std::int32_t cell : cells)
      if (const std::int64_t steps = climb(mesh_, cell, 0); steps > 0) {
        counts_.moved += steps;
        return true;
      }
    return false;
  }

  // Polyhedra that are nearly good, and then moves.
  void merge_and_climb(const std::vector<Merge>& nearly) {
    for (const Merge& one : nearly) {
      MeasuredMesh::Undo undo(mesh_, with_neighbours(mesh_, one.cells));
      merge_cells(mesh_, one.cells);
      const std::int64_t steps = climb(mesh_, one.cells[0], one.worth.refused);
      if (steps > 0) {
        counts_.moved += steps;
        return note(one);
      }
      undo.take_back();
    }
  }

  void keep(const Merge& merge) {
    note(merge);
    merge_cells(mesh_, merge.cells);
  }

  void note(const Merge& merge) {
    for (const std::int32_t cell : merge.cells) {
      if (is_polyhedron_.erase(cell) > 0)
        --counts_.into;
      else
        ++counts_.merged;
    }
    ++counts_.into;
    is_polyhedron_.insert(merge.cells[0]);
    hexes_left_ -= merge.worth.hex_volume;
  }

  void keep(const Cut& cut) {
    ++counts_.cut;
    hexes_left_ -= cut.worth.hex_volume;
    cut_cell(mesh_, cut);
  }

  MeasuredMesh& mesh_;
  double hexes_left_;
  MendCounts& counts_;
  std::set<std::int32_t> is_polyhedron_;
};

double volume_of(const MeasuredMesh& mesh, bool hexes_alone) {
  double volume = 0;
  for (std::int32_t cell = 0; cell < static_cast<std::int32_t>(mesh.cell_count()); ++cell)
    if (mesh.is_alive(cell) && (!hexes_alone || mesh.mesh().is_hex[cell] != 0)) volume += mesh.volume(cell);
  return volume;
}

}  // namespace

MendCounts mend_polyhedra(PolyhedralMesh& mesh, const std::vector<LayerCell>& cells) {
  constexpr double most_hexes = 0.001;
  MendCounts counts;
  MeasuredMesh measured(mesh);
  const MeasuredMesh::Refused before = measured.refused();
  counts.refused_before = counts.refused = static_cast<std::int64_t>(before.count());
  if (before.none()) return counts;
  const double volume = volume_of(measured, false);
  counts.hexes_before = volume_of(measured, true) / volume;
  counts.halved = split_single_layers(measured, cells, before);
  const auto after = Mender(measured, most_hexes * volume, counts).run(measured.refused_after(before));
  counts.refused = static_cast<std::int64_t>(after.count());
  counts.hexes = volume_of(measured, true) / volume;
  if (counts.changed()) renumber(mesh, measured.order());
  return counts;
}

std::string summary(const MendCounts& counts) {
  std::string line;
  if (counts.changed())
    line = fmt::format(
        "as OpenFOAM wants cells, {} are halved, {} cut, {} merged into {} polyhedra, and {} vertices moved; hexes are "
        "{:.2f} % of the volume, {:.2f} before",
        counts.halved, counts.cut, counts.merged, counts.into, counts.moved, 100 * counts.hexes,
        100 * counts.hexes_before);
  if (counts.refused > 0)
    line +=
        fmt::format("{}checkMesh finds fault with {} cells and faces{}", line.empty() ? "" : "; ", counts.refused,
                    counts.refused < counts.refused_before ? fmt::format(", {} before", counts.refused_before) : "");
  return line;
}

}  // namespace hexpipe::polyhedra
