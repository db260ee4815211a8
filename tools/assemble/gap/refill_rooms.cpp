#include "tools/assemble/gap/passes.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/refill.hpp"

namespace hexpipe::assemble::gap {
namespace {

// Later passes find little: on mambo-s1 at 2.3 the first finds 9 of 10.
constexpr int most_refilling_passes = 5;

class Rooms {
 public:
  explicit Rooms(GapMesh& gap)
      : gap_(gap), refill_(gap), seen_(gap.vertex_count(), std::numeric_limits<std::uint32_t>::max()) {}

  RefillCounts run() {
    for (int pass = 0; pass < most_refilling_passes; ++pass) {
      const RefillCounts before = counts_;
      std::vector<std::uint32_t> ages(gap_.vertex_count());
      for (std::size_t v = 0; v < ages.size(); ++v) ages[v] = gap_.age_of(static_cast<Vertex>(v));
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

RefillCounts refill_rooms(GapMesh& gap) {
  return Rooms(gap).run();
}

}  // namespace hexpipe::assemble::gap
