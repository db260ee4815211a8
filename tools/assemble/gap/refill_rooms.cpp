#include "tools/assemble/gap/passes.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/refill.hpp"

namespace hexpipe::assemble::gap {
namespace {

// Later passes find little: on mambo-s1 at 2.3 the first finds 9 of 10.
constexpr int most_refilling_passes = 5;
// How far from a change refill_rooms_since() looks: with none of these spot has 11 tets more, with ten 13 fewer, but it
// takes longer.
constexpr int rings_of_cells = 3;

class Rooms {
 public:
  static constexpr std::uint32_t never = std::numeric_limits<std::uint32_t>::max();

  // By vertex: its age when it was looked at before, and never for those that are new.
  Rooms(GapMesh& gap, std::vector<std::uint32_t> seen) : gap_(gap), refill_(gap), seen_(std::move(seen)) {
    seen_.resize(gap.vertex_count(), never);
  }

  RefillCounts run() {
    for (int pass = 0; pass < most_refilling_passes; ++pass) {
      const RefillCounts before = counts_;
      std::vector<std::uint32_t> ages = ages_of_vertices(gap_);
      refill_stars();
      refill_rings();
      refill_poor();
      seen_ = std::move(ages);
      if (counts_.vertices + counts_.edges + counts_.poor == before.vertices + before.edges + before.poor) break;
    }
    return counts_;
  }

 private:
  bool has_changed(Vertex v) const { return gap_.age_of(v) != seen_[v]; }

  void refill_stars();
  void refill_rings();
  void refill_rings_of(GapIndex c);
  void refill_poor();
  bool refill();

  GapMesh& gap_;
  Refill refill_;
  std::vector<std::uint32_t> seen_;  // by vertex: its age when it was looked at
  std::vector<GapIndex> room_;
  RefillCounts counts_;
};

bool Rooms::refill() {
  const auto in = refill_.find(room_);
  if (in) gap_.replace(room_, *in);
  return in.has_value();
}

void Rooms::refill_stars() {
  for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v) {
    if (!gap_.is_free(v) || !has_changed(v)) continue;
    room_.assign(gap_.cells_at(v).begin(), gap_.cells_at(v).end());
    counts_.vertices += refill() ? 1 : 0;
  }
}

// Looks only at edges of c all of whose cells are not older than c, so that each edge comes up once.
void Rooms::refill_rings_of(GapIndex c) {
  const GapCell cell = gap_.cell(c);
  with_topology(cell.kind, [&](auto topology) {
    for (const auto& edge : decltype(topology)::edges) {
      if (!gap_.is_alive(c)) return;
      const Vertex a = cell.corners[edge[0] % 6], b = cell.corners[edge[1] % 6];
      if (!has_changed(a) && !has_changed(b)) continue;
      room_.clear();
      for (const GapIndex other : gap_.cells_at(a))
        if (gap_.cell(other).has(b)) room_.push_back(other);
      if (room_.size() >= 3 && std::ranges::min(room_) == c) counts_.edges += refill() ? 1 : 0;
    }
  });
}

void Rooms::refill_rings() {
  for (const auto c : indices<GapIndex>(gap_.cell_count()))
    if (gap_.is_alive(c)) refill_rings_of(c);
}

void Rooms::refill_poor() {
  for (const auto c : indices<GapIndex>(gap_.cell_count()))
    if (gap_.is_alive(c) && gap_.cell(c).quality < least_quality &&
        std::ranges::any_of(gap_.cell(c).vertices(), [&](Vertex v) { return has_changed(v); }))
      counts_.poor += refill_around(gap_, refill_, c) ? 1 : 0;
}

}  // namespace

std::vector<std::uint32_t> ages_of_vertices(const GapMesh& gap) {
  std::vector<std::uint32_t> ages(gap.vertex_count());
  for (std::size_t v = 0; v < ages.size(); ++v) ages[v] = gap.age_of(static_cast<Vertex>(v));
  return ages;
}

RefillCounts refill_rooms(GapMesh& gap) {
  return Rooms(gap, {}).run();
}

RefillCounts refill_rooms_since(GapMesh& gap, std::vector<std::uint32_t> ages) {
  ages.resize(gap.vertex_count(), Rooms::never);
  for (int ring = 0; ring < rings_of_cells; ++ring) {
    std::vector<Vertex> beside;
    for (Vertex v = 0; v < static_cast<Vertex>(ages.size()); ++v)
      if (ages[static_cast<std::size_t>(v)] != gap.age_of(v))
        for (const GapIndex c : gap.cells_at(v))
          beside.insert(beside.end(), gap.cell(c).vertices().begin(), gap.cell(c).vertices().end());
    for (const Vertex v : beside) ages[static_cast<std::size_t>(v)] = Rooms::never;
  }
  return Rooms(gap, std::move(ages)).run();
}

}  // namespace hexpipe::assemble::gap
