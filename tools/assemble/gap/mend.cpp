// Single vertices have been placed before, each as well as it could: what is left needs other cells, or several
// vertices together (patch.hpp).

#include "tools/assemble/gap/passes.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/patch.hpp"
#include "tools/assemble/gap/refill.hpp"

namespace hexpipe::assemble::gap {
namespace {

constexpr int most_mending_passes = 3;
// Few cells are poor; the third round mended 5 and the fourth none on most models.
constexpr int most_rounds = 3;
constexpr int rounds_of_moves = 5, rounds_of_settling = 2;
// How good neighbours of a poor cell become so that it rises. With 0.15 a tet of 0.118 on bridge stays where it is.
constexpr double goal_of_neighbours = 0.2;

class Mender {
 public:
  explicit Mender(GapMesh& gap) : gap_(gap), refill_(gap), patch_(gap) {}

  std::int64_t run() {
    std::int64_t changes = 0;
    for (int pass = 0; pass < most_mending_passes; ++pass) {
      const std::int64_t before = changes;
      seen_.resize(gap_.cell_count(), never);
      for (const auto c : indices<GapIndex>(gap_.cell_count())) {
        if (!gap_.is_alive(c) || seen_[c] == gap_.age_of_cell(c)) continue;
        if (mend(c))
          ++changes;
        else
          seen_[c] = gap_.age_of_cell(c);
      }
      if (changes == before) break;
    }
    return changes;
  }

  // Cells from here on came when hexes gave way, or since.
  void opened_from(std::size_t first) { first_opened_ = std::min(first_opened_, GapIndex(first)); }

 private:
  static constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();
  bool mend(GapIndex c);
  bool raise_around(GapIndex c);
  bool raise(const std::vector<Vertex>& vertices);
  bool raise_with_neighbours(const std::vector<Vertex>& vertices);
  bool step(Vertex v);

  GapMesh& gap_;
  Refill refill_;
  Patch patch_;
  GapIndex first_opened_{std::numeric_limits<std::int32_t>::max()};
  // Ages when nothing helped. Changes beyond the neighbours do not raise them, which costs a chance at most.
  std::vector<std::uint64_t> seen_;    // by cell
  std::vector<std::uint64_t> stayed_;  // by vertex
};

bool Mender::raise(const std::vector<Vertex>& vertices) {
  if (vertices.empty()) return false;
  patch_.take(vertices, {});
  const double before = patch_.least();
  patch_.raise(least_quality, rounds_of_moves);
  if (patch_.least() < before + least_rise || !patch_.keeps_floors()) return false;
  if (!patch_.costs_at_most(patch_.cost_before() - least_gain)) return false;
  patch_.carry_out(gap_, {});
  return true;
}

bool Mender::raise_with_neighbours(const std::vector<Vertex>& vertices) {
  patch_.take(vertices, {});
  if (!patch_.raise_with_neighbours(goal_of_neighbours, least_quality, rounds_of_moves)) return false;
  patch_.carry_out(gap_, {});
  // Now that no cell there is poor, vertices go where the objective is less.
  patch_.take(vertices, {});
  if (patch_.lower_cost(rounds_of_settling, vertices.size()) > 0) patch_.carry_out(gap_, {});
  return true;
}

// The cell's own vertices, then those of all cells at these, too. What open_hexes() has left below least_quality may
// cost the neighbours something, so that merging leaves no cell poor where none was.
bool Mender::raise_around(GapIndex c) {
  const std::vector<Vertex> around = gap_.inner_vertices_around(c);
  if (raise(gap_.inner_vertices_of(c)) || raise(around)) return true;
  return c >= first_opened_ && gap_.cell(c).quality >= least_wanted && raise_with_neighbours(around);
}

bool Mender::step(Vertex v) {
  stayed_.resize(gap_.vertex_count(), never);
  if (stayed_[v] == gap_.age_of(v)) return false;
  if (step_to_lower_cost(gap_, patch_, v)) return true;
  stayed_[v] = gap_.age_of(v);
  return false;
}

bool Mender::mend(GapIndex c) {
  const bool is_poor = gap_.cell(c).quality < least_quality;
  const bool has_poor_face = cost_of_faces(gap_, c) > 0;
  if (!is_poor && !has_poor_face) return false;
  if (refill_around(gap_, refill_, c)) return true;
  if (is_poor && raise_around(c)) return true;
  if (!has_poor_face) return false;
  bool moved = false;
  for (const Vertex v : gap_.cell(c).vertices())
    if (gap_.is_inside(v)) moved = step(v) || moved;
  return moved;
}

}  // namespace

MendCounts mend(GapMesh& gap, bool may_open) {
  Mender mender(gap);
  MendCounts counts;
  const auto count = [&](std::int64_t mended, const Opened& opened) {
    counts.mended += mended + opened.inserted;
    counts.opened.insert(counts.opened.end(), opened.chosen.begin(), opened.chosen.end());
  };
  for (int round = 0; round < most_rounds; ++round) {
    const std::int64_t mended = mender.run();
    Opened opened;
    mender.opened_from(gap.cell_count());
    if (may_open) opened = open_hexes(gap);
    count(mended, opened);
    if (mended + opened.inserted == 0 && opened.chosen.empty()) break;
  }
  if (!may_open) return counts;
  std::vector<std::uint32_t> ages = ages_of_vertices(gap);
  const Opened wide = open_wide(gap);
  if (wide.inserted == 0) return counts;
  count(mender.run(), wide);
  const RefillCounts refilled = refill_rooms_since(gap, std::move(ages));
  counts.mended += refilled.vertices + refilled.edges + refilled.poor;
  return counts;
}

}  // namespace hexpipe::assemble::gap
