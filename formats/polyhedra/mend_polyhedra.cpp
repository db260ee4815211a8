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
#include "formats/polyhedra/leaving_out.hpp"
#include "formats/polyhedra/vertex_moving.hpp"

namespace hexpipe::polyhedra {
namespace {

constexpr double most_hexes = 0.001;  // that may become polyhedra, by volume

// Mends one cell or face after the other.
class Mender {
 public:
  Mender(MeasuredMesh& mesh, double volume, MendCounts& counts)
      : mesh_(mesh), volume_(volume), hexes_left_(most_hexes * volume), counts_(counts) {}

  // Returns what is left.
  MeasuredMesh::Refused run(MeasuredMesh::Refused refused) {
    for (const Pass& pass : passes) {
      if (refused.none()) break;
      pass_ = pass;
      run_pass(refused);
      refused = mesh_.refused_after(refused);
    }
    return refused;
  }

 private:
  struct Pass {
    bool thorough, with_hexes;
    ClimbEffort climbing;
  };
  static constexpr std::array<Pass, 3> passes{
      {{false, false, {8, 12}}, {true, false, {8, 12}}, {true, true, {20, 200}}}};

  void run_pass(const MeasuredMesh::Refused& refused) {
    for (const std::int32_t cell : refused.cells)
      if (is_wrong(cell)) mend(std::array{cell});
    for (const std::int32_t number : refused.faces) {
      const PolyhedralMesh::Face face = mesh_.mesh().faces[number];
      if (face.owner == no_index || (mesh_.refusals_of_face(number) & wrong) == 0) continue;
      const std::array cells{face.owner, face.neighbour};
      mend(std::span(cells).first(face.is_inner() ? 2 : 1));
    }
  }

  bool is_wrong(std::int32_t cell) const { return mesh_.is_alive(cell) && (mesh_.refusals_of_cell(cell) & wrong) != 0; }

  // Cells of which one is wrong, or whose face is. The least change goes first.
  void mend(std::span<const std::int32_t> cells) {
    if (!mend_at_once(cells)) leave_out_and_mend(cells);
  }

  bool mend_at_once(std::span<const std::int32_t> cells) {
    const double most = pass_.with_hexes ? std::max(0.0, hexes_left_) : 0;
    if (move(cells)) return true;
    std::vector<Merge> nearly;
    const std::optional<Merge> merge = best_merge(mesh_, cells, pass_.thorough, most, nearly);
    if (merge && merge->worth.hex_volume == 0) return keep(*merge);
    std::optional<Cut> cut;
    for (const std::int32_t cell : cells) {
      const auto one = best_cut(mesh_, cell, most);
      if (one && (!cut || one->worth < cut->worth)) cut = one;
    }
    if (cut && (!merge || cut->worth.hex_volume < merge->worth.hex_volume)) return keep(*cut);
    if (merge) return keep(*merge);
    return leave_one_out(cells) || climb_alone(cells) || merge_and_climb(nearly);
  }

  bool leave_one_out(std::span<const std::int32_t> cells) {
    for (const std::int32_t cell : cells) {
      const auto worth = worth_of_leaving_out(mesh_, cell);
      if (!worth || worth->refused >= 0) continue;
      count_out(cell, mesh_.volume(cell));
      leave_out(mesh_, cell);
      return true;
    }
    return false;
  }

  // A cell behind may be wrong in its turn, and mended.
  bool leave_out_and_mend(std::span<const std::int32_t> cells) {
    for (const std::int32_t cell : cells) {
      const auto worth = worth_of_leaving_out(mesh_, cell);
      if (!worth || worth->refused > 0) continue;
      const CellSet around = with_neighbours(mesh_, {cell});
      MeasuredMesh::Undo undo(mesh_, around);
      const double volume = mesh_.volume(cell);
      leave_out(mesh_, cell);
      for (const std::int32_t behind : around)
        if (is_wrong(behind) && mend_at_once(std::array{behind})) {
          count_out(cell, volume);
          return true;
        }
      undo.take_back();
    }
    return false;
  }

  void count_out(std::int32_t cell, double volume) {
    ++counts_.left_out;
    counts_.left_out_volume += volume / volume_;
    if (is_polyhedron_.erase(cell) > 0) --counts_.into;
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
      if (const std::int64_t steps = climb(mesh_, cell, 0, pass_.climbing); steps > 0) {
        counts_.moved += steps;
        return true;
      }
    return false;
  }

  // Polyhedra that are nearly good, and then moves.
  bool merge_and_climb(const std::vector<Merge>& nearly) {
    for (const Merge& one : nearly) {
      MeasuredMesh::Undo undo(mesh_, with_neighbours(mesh_, one.cells));
      merge_cells(mesh_, one.cells);
      const std::int64_t steps = climb(mesh_, one.cells[0], one.worth.refused, pass_.climbing);
      if (steps > 0) {
        counts_.moved += steps;
        note(one);
        return true;
      }
      undo.take_back();
    }
    return false;
  }

  bool keep(const Merge& merge) {
    note(merge);
    merge_cells(mesh_, merge.cells);
    return true;
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

  bool keep(const Cut& cut) {
    ++counts_.cut;
    hexes_left_ -= cut.worth.hex_volume;
    cut_cell(mesh_, cut);
    return true;
  }

  MeasuredMesh& mesh_;
  double volume_, hexes_left_;
  Pass pass_ = passes[0];
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
  MendCounts counts;
  MeasuredMesh measured(mesh);
  const MeasuredMesh::Refused before = measured.refused();
  counts.refused_before = counts.refused = static_cast<std::int64_t>(before.count());
  if (before.none()) return counts;
  const double volume = volume_of(measured, false);
  counts.hexes_before = volume_of(measured, true) / volume;
  counts.halved = split_single_layers(measured, cells, before);
  const auto after = Mender(measured, volume, counts).run(measured.refused_after(before));
  counts.refused = static_cast<std::int64_t>(after.count());
  counts.hexes = volume_of(measured, true) / volume;
  if (counts.changed()) renumber(mesh, measured.order());
  return counts;
}

std::string summary(const MendCounts& counts) {
  std::string line;
  if (counts.changed())
    line = fmt::format(
        "for OpenFOAM's checkMesh {} cells are halved, {} cut, {} merged into {} polyhedra, {} left out "
        "({:.4f} % of the volume), and {} vertices moved; hexes are "
        "{:.2f} % of the volume, {:.2f} before",
        counts.halved, counts.cut, counts.merged, counts.into, counts.left_out, 100 * counts.left_out_volume,
        counts.moved, 100 * counts.hexes, 100 * counts.hexes_before);
  if (counts.refused > 0)
    line +=
        fmt::format("{}checkMesh finds fault with {} cells and faces{}", line.empty() ? "" : "; ", counts.refused,
                    counts.refused < counts.refused_before ? fmt::format(", {} before", counts.refused_before) : "");
  return line;
}

}  // namespace hexpipe::polyhedra
