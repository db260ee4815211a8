#include "tools/assemble/rooms.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "tools/assemble/objective.hpp"
#include "tools/assemble/refill.hpp"

namespace hexpipe {
namespace {

// Changes that gain less are not worth it.
constexpr double least_gain = 0.01;
constexpr int most_passes = 5;

class Rooms {
 public:
  explicit Rooms(GapMesh& gap) : gap_(gap), refill_(gap), changed_(gap.vertex_count(), 0), looked_(gap.vertex_count(), -1) {}

  RoomCounts run() {
    for (pass_ = 0; pass_ < most_passes; ++pass_) {
      const auto before = counts_;
      for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v)
        if (gap_.is_free(v) && changed_[v] >= pass_ - 1) counts_.vertices += empty_star(v);
      const std::size_t count = gap_.cell_count();
      for (std::size_t c = 0; c < count; ++c) edges_of(static_cast<std::int32_t>(c));
      if (counts_.vertices + counts_.edges == before.vertices + before.edges) break;
    }
    return counts_;
  }

 private:
  bool empty_star(Vertex v) {
    const auto around = gap_.cells_at(v);
    room_.assign(around.begin(), around.end());
    return try_room();
  }

  void edges_of(std::int32_t c) {
    if (!gap_.is_alive(c)) return;
    const GapCell cell = gap_.cell(c);
    with_topology(cell.kind, [&](auto topology) {
      for (const auto& e : decltype(topology)::edges) {
        const Vertex a = cell.corners[e[0]], b = cell.corners[e[1]];
        if (!gap_.is_alive(c)) return;
        if (changed_[a] < pass_ - 1 && changed_[b] < pass_ - 1) continue;
        room_.clear();
        for (const std::int32_t other : gap_.cells_at(a))
          if (gap_.cell(other).has(b)) room_.push_back(other);
        if (room_.front() != c && std::ranges::min(room_) != c) continue;
        if (room_.size() >= 3) counts_.edges += try_room();
      }
    });
  }

  bool try_room() {
    double cost = 0, worst = least_merged_quality;
    for (const std::int32_t c : room_) {
      cost += cell_cost(gap_.cell(c).quality);
      worst = std::min(worst, gap_.cell(c).quality);
    }
    const auto in = refill_.find(room_, worst, cost - least_gain);
    if (!in) return false;
    for (const std::int32_t c : room_)
      for (const Vertex v : gap_.cell(c).vertices()) changed_[v] = pass_;
    gap_.replace(room_, *in);
    return true;
  }

  GapMesh& gap_;
  Refill refill_;
  int pass_ = 0;
  std::vector<int> changed_, looked_;  // the pass in which cells at a vertex changed
  std::vector<std::int32_t> room_;
  RoomCounts counts_;
};

}  // namespace

RoomCounts refill_rooms(GapMesh& gap) {
  return Rooms(gap).run();
}

}  // namespace hexpipe
