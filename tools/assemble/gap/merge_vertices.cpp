// An edge collapse, with pyramids: H. Hoppe, "Progressive meshes" (1996); T. K. Dey, H. Edelsbrunner, S. Guha, D. V.
// Nekhayev, "Topology preserving edge contraction" (1999). Their link condition is not asked for, because geometry says
// more. Let vertex a lie inside, with valid tets and pyramids of apex a alone around it. Seen from a every point of the
// skin of these cells lies in a direction of its own, so that the skin is a sphere S that does not meet itself. Merging
// a into b on S leaves the cone from b over the facets of S that do not have b. The signed sum of the cone's cells has
// S as its boundary, as long as b is no corner of a quad of S; and if all of them are positive everywhere, each point
// inside S lies in exactly one (its winding number is 1). The cells tile what they tiled before. No edge or facet
// between them is one that is elsewhere too, because the same straight edge would be inside S and outside; for the same
// reason none is the diagonal of a quad.

#include "tools/assemble/gap/passes.hpp"

#include <algorithm>
#include <queue>
#include <vector>

#include "common/mesh/item_lists.hpp"
#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/skin.hpp"

namespace hexpipe::assemble::gap {
namespace {

struct Merge {
  double gain = 0;
  Vertex from = 0, into = 0;
  std::uint32_t age = 0;  // of `from` when this was found

  bool operator<(const Merge& other) const {
    if (gain != other.gain) return gain < other.gain;
    return from > other.from;
  }
};

class Merger {
 public:
  explicit Merger(GapMesh& gap) : gap_(gap) {}

  std::int64_t run() {
    for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v) offer(v);
    std::int64_t merged = 0;
    while (!offers_.empty()) {
      const Merge best = offers_.top();
      offers_.pop();
      // Something there has changed: then it was offered anew.
      if (best.age == gap_.age_of(best.from)) merged += carry_out(best) ? 1 : 0;
    }
    return merged;
  }

 private:
  bool may_leave(Vertex v) const;
  void collect_goals(Vertex v);
  GapCell moved(const GapCell& cell, Vertex from, Vertex into) const;
  double cost_after(Vertex from, Vertex into, double floor, double most) const;
  void offer(Vertex v);
  bool carry_out(const Merge& merge);

  GapMesh& gap_;
  std::priority_queue<Merge> offers_;
  std::vector<Vertex> goals_, barred_;
};

bool Merger::may_leave(Vertex v) const {
  return gap_.is_free(v) && std::ranges::all_of(gap_.cells_at(v), [&](GapIndex c) {
           const GapCell& cell = gap_.cell(c);
           return cell.kind == CellKind::tet || (cell.kind == CellKind::pyramid && cell.corners[4] == v);
         });
}

// The neighbours of v that are no corners of a quad around it.
void Merger::collect_goals(Vertex v) {
  goals_.clear(), barred_.clear();
  for (const GapIndex c : gap_.cells_at(v)) {
    const GapCell& cell = gap_.cell(c);
    auto& list = cell.kind == CellKind::tet ? goals_ : barred_;
    list.insert(list.end(), cell.vertices().begin(), cell.vertices().end());
  }
  barred_.push_back(v);
  sort_unique(goals_);
  sort_unique(barred_);
  std::erase_if(goals_, [&](Vertex w) { return std::ranges::binary_search(barred_, w); });
}

GapCell Merger::moved(const GapCell& cell, Vertex from, Vertex into) const {
  auto corners = cell.corners;
  std::ranges::replace(corners, from, into);
  return gap_.make(cell.kind, corners, cell.region);
}

// The cost of the cells that the merge leaves; more than `most` if one is below the floor, or if they cost more.
double Merger::cost_after(Vertex from, Vertex into, double floor, double most) const {
  double cost = 0;
  for (const GapIndex c : gap_.cells_at(from)) {
    if (gap_.cell(c).has(into)) continue;
    const double quality = moved(gap_.cell(c), from, into).quality;
    if (quality < floor) return most + 1;
    cost += cost_of(quality);
    if (cost > most) return cost;
  }
  return cost;
}

void Merger::offer(Vertex v) {
  if (!may_leave(v)) return;
  const Worth now = worth_of(gap_, gap_.cells_at(v));
  collect_goals(v);
  Merge best{least_gain, v, no_index, gap_.age_of(v)};
  for (const Vertex into : goals_) {
    const double gain = now.cost - cost_after(v, into, now.floor, now.cost - best.gain);
    if (gain > best.gain) best.gain = gain, best.into = into;
  }
  if (best.into != no_index) offers_.push(best);
}

bool Merger::carry_out(const Merge& merge) {
  const auto around = gap_.cells_at(merge.from);
  const std::vector<GapIndex> out(around.begin(), around.end());
  std::vector<GapCell> in;
  std::vector<Vertex> touched;
  for (const GapIndex c : out) {
    touched.insert(touched.end(), gap_.cell(c).vertices().begin(), gap_.cell(c).vertices().end());
    if (!gap_.cell(c).has(merge.into)) in.push_back(moved(gap_.cell(c), merge.from, merge.into));
  }
  if (!std::ranges::all_of(in, [&](const GapCell& cell) { return is_valid(gap_, cell); })) return false;
  if (cost_of_faces(gap_, in, out) > cost_of_faces(gap_, out) + merge.gain - least_gain) return false;
  gap_.replace(out, in);
  sort_unique(touched);
  for (const Vertex v : touched) offer(v);
  return true;
}

}  // namespace

std::int64_t merge_vertices(GapMesh& gap) {
  return Merger(gap).run();
}

}  // namespace hexpipe::assemble::gap
