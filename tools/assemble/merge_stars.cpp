// The cells around two vertices are a room; all of its skin is joined to one vertex inside. That the new cells tile the
// room where all of them are positive is as in refill.cpp. The place is found as in smoothing.

#include "tools/assemble/merge_stars.hpp"

#include <algorithm>
#include <array>
#include <queue>
#include <span>
#include <vector>

#include "common/mesh/quality.hpp"
#include "tools/assemble/objective.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe {
namespace {

constexpr double least_gain = 0.01;
constexpr int most_steps = 8;

struct Merge {
  double gain = 0;
  Vertex from = 0, into = 0;
  std::array<std::uint32_t, 2> ages{};
  Vec3 at{};

  bool operator<(const Merge& other) const {
    if (gain != other.gain) return gain < other.gain;
    if (from != other.from) return from > other.from;
    return into > other.into;
  }
};

// Counter-clockwise as seen from outside the room; of a triangle the last is none.
using Facet = std::array<Vertex, 4>;

class StarMerger {
 public:
  explicit StarMerger(GapMesh& gap) : gap_(gap), age_(gap.vertex_count()) {}

  std::int64_t run() {
    for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v) offer(v, true);
    std::int64_t merged = 0;
    while (!offers_.empty()) {
      const Merge best = offers_.top();
      offers_.pop();
      if (best.ages != std::array{age_[best.from], age_[best.into]}) continue;
      carry_out(best);
      ++merged;
    }
    return merged;
  }

 private:
  void collect_partners(Vertex v);
  void offer(Vertex v, bool upwards);
  void offer_pair(Vertex from, Vertex into);
  bool collect_room(Vertex a, Vertex b);
  GapCell cone(const Facet& facet, Vertex apex, std::int32_t region) const;
  void carry_out(const Merge& merge);

  GapMesh& gap_;
  std::vector<std::uint32_t> age_;
  std::priority_queue<Merge> offers_;
  std::vector<Vertex> partners_;
  std::vector<std::int32_t> room_;
  std::vector<Facet> skin_;
};

// Free vertices of the cells at v and of those behind their facets.
void StarMerger::collect_partners(Vertex v) {
  partners_.clear();
  for (const std::int32_t c : gap_.cells_at(v)) {
    const auto own = gap_.cell(c).vertices();
    for (const Vertex w : own) {
      if (w == v) continue;
      if (gap_.is_free(w)) partners_.push_back(w);
      for (const std::int32_t other : gap_.cells_at(w)) {
        int shared = 0;
        for (const Vertex x : own) shared += gap_.cell(other).has(x);
        if (shared < 3) continue;
        for (const Vertex x : gap_.cell(other).vertices())
          if (x != v && gap_.is_free(x)) partners_.push_back(x);
      }
    }
  }
  std::ranges::sort(partners_);
  partners_.erase(std::unique(partners_.begin(), partners_.end()), partners_.end());
}

void StarMerger::offer(Vertex v, bool upwards) {
  if (!gap_.is_free(v)) return;
  collect_partners(v);
  const auto partners = partners_;
  for (const Vertex other : partners)
    if (!upwards || other > v) offer_pair(v, other);
}

template <class Visit>
void for_facets(const GapCell& cell, Visit&& visit) {
  with_topology(cell.kind, [&](auto topology) {
    if constexpr (topology.corner_count <= 6) {
      for (const auto& t : decltype(topology)::triangles)
        visit(Facet{cell.corners[t[0]], cell.corners[t[1]], cell.corners[t[2]], GapMesh::none});
      for (const auto& q : decltype(topology)::quads)
        visit(Facet{cell.corners[q[0]], cell.corners[q[1]], cell.corners[q[2]], cell.corners[q[3]]});
    }
  });
}

// The cells at a or b, and their skin; false where they are no room that could be filled anew.
bool StarMerger::collect_room(Vertex a, Vertex b) {
  room_.clear(), skin_.clear();
  for (const Vertex v : {a, b}) room_.insert(room_.end(), gap_.cells_at(v).begin(), gap_.cells_at(v).end());
  std::ranges::sort(room_);
  room_.erase(std::unique(room_.begin(), room_.end()), room_.end());
  const std::int32_t region = gap_.cell(room_[0]).region;
  for (const std::int32_t c : room_) {
    if (gap_.cell(c).region != region) return false;
    bool blocked = false;
    for_facets(gap_.cell(c), [&](const Facet& facet) {
      auto key = [](Facet f) {
        std::ranges::sort(f);
        return f;
      };
      const auto twin = std::ranges::find_if(skin_, [&](const Facet& f) { return key(f) == key(facet); });
      if (twin == skin_.end()) {
        skin_.push_back(facet);
        return;
      }
      if (facet[3] == GapMesh::none && gap_.is_tagged({facet[0], facet[1], facet[2]})) blocked = true;
      skin_.erase(twin);
    });
    if (blocked) return false;
  }
  // A quad or triangle at one of the two is none of the room's skin.
  return std::ranges::none_of(
      skin_, [&](const Facet& f) { return std::ranges::find(f, a) != f.end() || std::ranges::find(f, b) != f.end(); });
}

GapCell StarMerger::cone(const Facet& f, Vertex apex, std::int32_t region) const {
  if (f[3] == GapMesh::none) return gap_.make(CellKind::tet, {f[0], f[2], f[1], apex}, region);
  return gap_.make(CellKind::pyramid, {f[0], f[3], f[2], f[1], apex}, region);
}

void StarMerger::offer_pair(Vertex from, Vertex into) {
  if (!collect_room(from, into)) return;
  double cost = 0, worst = least_merged_quality;
  for (const std::int32_t c : room_) {
    cost += cell_cost(gap_.cell(c).quality);
    worst = std::min(worst, gap_.cell(c).quality);
  }
  if (static_cast<double>(skin_.size()) > cost - least_gain) return;
  PointStar star;
  const std::span<Vec3> points = gap_.points();
  for (const Facet& f : skin_) {
    if (f[3] == GapMesh::none)
      star.add(CellKind::tet, std::array{points[f[0]], points[f[2]], points[f[1]], Vec3{}}, 3);
    else
      star.add(CellKind::pyramid, std::array{points[f[0]], points[f[3]], points[f[2]], points[f[1]], Vec3{}}, 4);
  }
  const Placement place = raise_worst(star, (points[from] + points[into]) * 0.5, most_steps);
  if (place.worst < worst) return;
  const Vec3 before = points[into];
  gap_.points()[into] = place.at;
  double after = 0;
  for (const Facet& f : skin_) after += cell_cost(cone(f, into, 0).quality);
  gap_.points()[into] = before;
  if (cost - after > least_gain) offers_.push({cost - after, from, into, {age_[from], age_[into]}, place.at});
}

void StarMerger::carry_out(const Merge& merge) {
  collect_room(merge.from, merge.into);
  std::vector<Vertex> touched{merge.into};
  for (const Facet& f : skin_)
    for (const Vertex v : f)
      if (v != GapMesh::none) touched.push_back(v);
  const std::int32_t region = gap_.cell(room_[0]).region;
  gap_.points()[merge.into] = merge.at;
  std::vector<GapCell> in;
  for (const Facet& f : skin_) in.push_back(cone(f, merge.into, region));
  gap_.replace(room_, in);
  ++age_[merge.from];
  std::ranges::sort(touched);
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  for (const Vertex v : touched) ++age_[v];
  for (const Vertex v : touched) offer(v, false);
}

}  // namespace

std::int64_t merge_stars(GapMesh& gap) {
  return StarMerger(gap).run();
}

}  // namespace hexpipe
