// An edge collapse, with pyramids: H. Hoppe, "Progressive meshes" (1996); T. K. Dey, H. Edelsbrunner, S. Guha,
// D. V. Nekhayev, "Topology preserving edge contraction" (1999). The link condition is not asked for, because geometry
// says more. Let vertex a lie inside, with valid tets and pyramids of apex a alone around it. Seen from a every point
// of the skin of these cells lies in a direction of its own, so that the skin is a sphere S that does not meet itself.
// Merging a into b on S leaves the cone from b over the facets of S that do not have b. The signed sum of the cone's
// cells has S as its boundary, as long as b is no corner of a quad of S; and if all of them are positive everywhere,
// each point inside S lies in exactly one (its winding number is 1). The cells tile what they tiled before; no edge or
// facet between them can be one that is elsewhere, for the same straight edge would be inside S and outside.

#include "tools/assemble/merge_vertices.hpp"

#include <algorithm>
#include <queue>
#include <vector>

#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "tools/assemble/objective.hpp"
#include "tools/assemble/refill.hpp"

namespace hexpipe {
namespace {

// Valid beyond doubt: far more than rounding.
constexpr double surely_valid = 1e-6;
// Merges that gain less are not worth it.
constexpr double least_gain = 0.01;

struct Merge {
  double gain = 0;
  Vertex from = 0, into = 0;
  std::uint32_t age = 0;  // of `from` when this was found

  bool operator<(const Merge& other) const {
    if (gain != other.gain) return gain < other.gain;
    if (from != other.from) return from > other.from;
    return into > other.into;
  }
};

class Merger {
 public:
  explicit Merger(GapMesh& gap) : gap_(gap), age_(gap.vertex_count()) {}

  std::int64_t run() {
    for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v) offer(v);
    std::int64_t merged = 0;
    while (!offers_.empty()) {
      const Merge best = offers_.top();
      offers_.pop();
      if (best.age != age_[best.from]) continue;
      carry_out(best);
      ++merged;
    }
    return merged;
  }

 private:
  bool may_leave(Vertex v) const;
  void collect_goals(Vertex v);
  double cost_after(Vertex from, Vertex into, double floor, double most) const;
  void offer(Vertex v);
  void carry_out(const Merge& merge);
  GapCell moved(const GapCell& cell, Vertex from, Vertex into) const;

  GapMesh& gap_;
  std::vector<std::uint32_t> age_;  // by vertex: rises whenever a cell there changes
  std::priority_queue<Merge> offers_;
  std::vector<Vertex> goals_, barred_;
};

bool Merger::may_leave(Vertex v) const {
  if (!gap_.is_free(v)) return false;
  return std::ranges::all_of(gap_.cells_at(v), [&](std::int32_t c) {
    const GapCell& cell = gap_.cell(c);
    return cell.quality > surely_valid && (cell.kind == CellKind::tet || (cell.kind == CellKind::pyramid && cell.corners[4] == v));
  });
}

// The neighbours of v that are no corners of a quad around it.
void Merger::collect_goals(Vertex v) {
  goals_.clear(), barred_.clear();
  for (const std::int32_t c : gap_.cells_at(v)) {
    const GapCell& cell = gap_.cell(c);
    auto& list = cell.kind == CellKind::tet ? goals_ : barred_;
    for (const Vertex w : cell.vertices())
      if (w != v) list.push_back(w);
  }
  for (auto* list : {&goals_, &barred_}) {
    std::ranges::sort(*list);
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  std::erase_if(goals_, [&](Vertex w) { return std::ranges::binary_search(barred_, w); });
}

GapCell Merger::moved(const GapCell& cell, Vertex from, Vertex into) const {
  auto corners = cell.corners;
  std::ranges::replace(corners, from, into);
  return gap_.make(cell.kind, corners, cell.region);
}

// Of the cells that the merge leaves; more than `most` where one is below the floor, or it is not worth counting on.
double Merger::cost_after(Vertex from, Vertex into, double floor, double most) const {
  double cost = 0;
  for (const std::int32_t c : gap_.cells_at(from)) {
    if (gap_.cell(c).has(into)) continue;
    const double quality = moved(gap_.cell(c), from, into).quality;
    if (quality < floor) return most + 1;
    cost += cell_cost(quality);
    if (cost > most) return cost;
  }
  return cost;
}

void Merger::offer(Vertex v) {
  if (!may_leave(v)) return;
  double cost = 0, worst = least_merged_quality;
  for (const std::int32_t c : gap_.cells_at(v)) {
    cost += cell_cost(gap_.cell(c).quality);
    worst = std::min(worst, gap_.cell(c).quality);
  }
  collect_goals(v);
  Merge best{least_gain, v, GapMesh::none, age_[v]};
  for (const Vertex into : goals_) {
    const double after = cost_after(v, into, worst, cost - best.gain);
    if (cost - after > best.gain) best.gain = cost - after, best.into = into;
  }
  if (best.into != GapMesh::none) offers_.push(best);
}

void Merger::carry_out(const Merge& merge) {
  const auto around = gap_.cells_at(merge.from);
  const std::vector<std::int32_t> out(around.begin(), around.end());
  std::vector<GapCell> in;
  std::vector<Vertex> touched;
  for (const std::int32_t c : out) {
    for (const Vertex v : gap_.cell(c).vertices()) touched.push_back(v);
    if (!gap_.cell(c).has(merge.into)) in.push_back(moved(gap_.cell(c), merge.from, merge.into));
  }
  gap_.replace(out, in);
  std::ranges::sort(touched);
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  for (const Vertex v : touched) ++age_[v];
  for (const Vertex v : touched) offer(v);
}

}  // namespace

std::int64_t merge_vertices(GapMesh& gap) {
  return Merger(gap).run();
}

}  // namespace hexpipe
