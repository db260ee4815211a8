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

constexpr double most_hexes = 0.001;  // the share of the volume in hexes that may become polyhedra

// Mends one cell or face after the other, by the list in the header.
class Mender {
 public:
  Mender(MeasuredMesh& mesh, double volume, std::int64_t most_measurements, MendCounts& counts)
      : mesh_(mesh),
        volume_(volume),
        hexes_left_(most_hexes * volume),
        last_measurement_(mesh.measurements() + most_measurements),
        counts_(counts) {}

  // Returns what is still wrong.
  MeasuredMesh::Refused run(MeasuredMesh::Refused refused) {
    for (const Pass& pass : passes) {
      if (refused.none() || is_at_limit()) break;
      pass_ = pass;
      run_pass(refused);
      refused = mesh_.refused_after(refused);
    }
    counts_.ended_early = is_at_limit() && !refused.none();
    return refused;
  }

 private:
  // What most cells need is quick. Only what is left is worth a longer search, and then hexes.
  struct Pass {
    bool thorough, with_hexes;
    ClimbEffort climbing;
  };
  static constexpr std::array<Pass, 3> passes{
      {{false, false, {8, 12}}, {true, false, {8, 12}}, {true, true, {20, 200}}}};

  void run_pass(const MeasuredMesh::Refused& refused) {
    for (const std::int32_t cell : refused.cells) {
      if (is_at_limit()) return;
      if (is_wrong(cell)) mend(std::array{cell});
    }
    for (const std::int32_t number : refused.faces) {
      if (is_at_limit()) return;
      const PolyhedralMesh::Face face = mesh_.mesh().faces[number];
      if (face.owner == no_index || (mesh_.refusals_of_face(number) & wrong) == 0) continue;
      const std::array cells{face.owner, face.neighbour};
      mend(std::span(cells).first(face.is_inner() ? 2 : 1));
    }
  }

  bool is_at_limit() const { return mesh_.measurements() >= last_measurement_; }

  bool is_wrong(std::int32_t cell) const { return mesh_.is_alive(cell) && (mesh_.refusals_of_cell(cell) & wrong) != 0; }

  // One wrong cell, or the one or two cells at a wrong face.
  void mend(std::span<const std::int32_t> cells) {
    if (!mend_at_once(cells)) leave_out_and_mend(cells);
  }

  bool mend_at_once(std::span<const std::int32_t> cells) {
    const double hexes_now = pass_.with_hexes ? std::max(0.0, hexes_left_) : 0;
    if (move(cells)) return true;
    std::vector<Merge> near_misses;
    const std::optional<Merge> merge = best_merge(mesh_, cells, pass_.thorough, hexes_now, near_misses);
    if (merge && merge->cost.hex_volume_lost == 0) return keep(*merge);
    std::optional<Cut> cut;
    for (const std::int32_t cell : cells) {
      const auto one = best_cut(mesh_, cell, hexes_now);
      if (one && (!cut || one->cost < cut->cost)) cut = one;
    }
    if (cut && (!merge || cut->cost.hex_volume_lost < merge->cost.hex_volume_lost)) return keep(*cut);
    if (merge) return keep(*merge);
    return leave_one_out(cells) || climb_alone(cells) || merge_and_climb(near_misses);
  }

  bool leave_one_out(std::span<const std::int32_t> cells) {
    for (const std::int32_t cell : cells) {
      const auto cost = cost_of_leaving_out(mesh_, cell);
      if (!cost || cost->wrong_added >= 0) continue;
      count_out(cell, mesh_.volume(cell));
      leave_out(mesh_, cell);
      return true;
    }
    return false;
  }

  // If it leaves no more wrong than before, and one of the cells behind it can be mended at once.
  bool leave_out_and_mend(std::span<const std::int32_t> cells) {
    for (const std::int32_t cell : cells) {
      const auto cost = cost_of_leaving_out(mesh_, cell);
      if (!cost || cost->wrong_added > 0) continue;
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
    if (polyhedra_.erase(cell) > 0) --counts_.polyhedra;
  }

  bool move(std::span<const std::int32_t> cells) {
    std::optional<Move> best;
    for (const std::int32_t cell : cells) {
      const auto one = best_move(mesh_, cell);
      if (one && (!best || one->cost < best->cost)) best = one;
    }
    if (!best) return false;
    ++counts_.moves;
    move_vertex(mesh_, *best);
    return true;
  }

  bool climb_alone(std::span<const std::int32_t> cells) {
    for (const std::int32_t cell : cells)
      if (const std::int64_t steps = climb(mesh_, cell, 0, pass_.climbing); steps > 0) {
        counts_.moves += steps;
        return true;
      }
    return false;
  }

  // A polyhedron that is nearly good becomes good if its vertices move.
  bool merge_and_climb(const std::vector<Merge>& near_misses) {
    for (const Merge& one : near_misses) {
      MeasuredMesh::Undo undo(mesh_, with_neighbours(mesh_, one.cells));
      merge_cells(mesh_, one.cells);
      const std::int64_t steps = climb(mesh_, one.cells[0], one.cost.wrong_added, pass_.climbing);
      if (steps > 0) {
        counts_.moves += steps;
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
      if (polyhedra_.erase(cell) > 0)
        --counts_.polyhedra;
      else
        ++counts_.merged;
    }
    ++counts_.polyhedra;
    polyhedra_.insert(merge.cells[0]);
    hexes_left_ -= merge.cost.hex_volume_lost;
  }

  bool keep(const Cut& cut) {
    ++counts_.cut;
    hexes_left_ -= cut.cost.hex_volume_lost;
    cut_cell(mesh_, cut);
    return true;
  }

  MeasuredMesh& mesh_;
  double volume_;      // of the mesh
  double hexes_left_;  // volume of hexes that may still become polyhedra
  std::int64_t last_measurement_;
  Pass pass_ = passes[0];
  MendCounts& counts_;
  std::set<std::int32_t> polyhedra_;  // cells that others merged into
};

double volume_of(const MeasuredMesh& mesh, bool hexes_alone) {
  double volume = 0;
  for (std::int32_t cell = 0; cell < static_cast<std::int32_t>(mesh.cell_count()); ++cell)
    if (mesh.is_alive(cell) && (!hexes_alone || mesh.mesh().is_hex[cell] != 0)) volume += mesh.volume(cell);
  return volume;
}

}  // namespace

MendCounts mend_polyhedra(PolyhedralMesh& mesh, const std::vector<LayerCell>& cells,
                          std::optional<std::int64_t> most_measurements) {
  constexpr std::int64_t usual = 2'000'000, usual_of_each = 2;
  MendCounts counts;
  MeasuredMesh measured(mesh);
  const MeasuredMesh::Refused before = measured.refused();
  counts.refused_before = counts.refused = static_cast<std::int64_t>(before.count());
  if (before.none()) return counts;
  const double volume = volume_of(measured, false);
  counts.hexes_before = volume_of(measured, true) / volume;
  counts.halved = split_single_layers(measured, cells, before);
  const std::int64_t most =
      most_measurements.value_or(usual + usual_of_each * static_cast<std::int64_t>(measured.cell_count()));
  const auto after = Mender(measured, volume, most, counts).run(measured.refused_after(before));
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
        counts.halved, counts.cut, counts.merged, counts.polyhedra, counts.left_out, 100 * counts.left_out_volume,
        counts.moves, 100 * counts.hexes, 100 * counts.hexes_before);
  if (counts.refused > 0)
    line +=
        fmt::format("{}checkMesh finds fault with {} cells and faces{}", line.empty() ? "" : "; ", counts.refused,
                    counts.refused < counts.refused_before ? fmt::format(", {} before", counts.refused_before) : "");
  if (counts.ended_early) line += "; mending has ended at its limit of work";
  return line;
}

}  // namespace hexpipe::polyhedra
