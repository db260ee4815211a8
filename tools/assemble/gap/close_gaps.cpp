// Where vertex a of some chosen cells becomes vertex b of others, all cells at a change, and those that have both
// vanish. Each other cell of the gap at a gets b in its place, or its room is filled anew (refill.hpp). What is filled
// has the skin that the map from a to b leaves: maps of vertices and boundaries commute. So the signed sum of the skins
// of all cells at a and b, the chosen ones among them, is what it was, but for the surface, where merge_on_surface.cpp
// tells why nothing is counted twice. All of these cells are positive everywhere, so that they tile what they tiled
// before (as in merge_vertices.cpp), and no two share more than a facet, an edge or a vertex of both.

#include "tools/assemble/gap/close_gaps.hpp"

#include <algorithm>

#include "common/mesh/item_lists.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/skin.hpp"

namespace hexpipe::assemble::gap {
namespace {

// Before the vertices around make room, chosen cells may be as poor as the first, and cells of the gap as the second:
// with 0 there simp has 66.9 % of the number in hexes in place of 67.1.
constexpr double least_chosen = 0.05, least_to_yield = -0.3;
// What a filling may cost more than the cells before it, because it becomes better when vertices move.
constexpr double slack = 0.5;
// A cell that will be moved counts as no worse than this.
constexpr double hoped_for = 0.3;
// How good the cells around become, if they can: a hex counts half (patch.cpp), and has to come to 0.3.
constexpr double goal = 0.17;
constexpr int rounds_of_closing = 6;

}  // namespace

bool GapCloser::may_close(Vertex from, Vertex into) const {
  for (const Vertex v : {from, into})
    if (gap_.is_at_seam(v) || gap_.cells_at(v).empty()) return false;
  for (const KeptIndex k : gap_.kept_at(from))
    for (const Vertex v : gap_.kept_cell(k).vertices())
      if (v == into || gap_.is_at_seam(v)) return false;
  return true;
}

GapCell GapCloser::moved(GapIndex c, const VertexMerge& merge) const {
  auto corners = gap_.cell(c).corners;
  std::ranges::replace(corners, merge.from, merge.into);
  return gap_.make(gap_.cell(c).kind, corners, gap_.cell(c).region);
}

bool GapCloser::suits_chosen(const VertexMerge& merge) {
  const Vec3 before = gap_.points()[merge.into];
  gap_.move(merge.into, merge.at);
  bool suits = true;
  for (const Vertex v : {merge.from, merge.into})
    for (const KeptIndex k : gap_.kept_at(v)) {
      KeptCell cell = gap_.kept_cell(k);
      std::ranges::replace(cell.corners, merge.from, merge.into);
      suits = suits && quality_of(cell.kind, gap_.points(), cell.vertices()) > least_chosen;
    }
  gap_.move(merge.into, before);
  return suits;
}

// The cells of the gap that vanish, or that are far too poor with the other vertex.
std::vector<GapIndex> GapCloser::hole_of(const VertexMerge& merge) {
  const Vec3 before = gap_.points()[merge.into];
  gap_.move(merge.into, merge.at);
  std::vector<GapIndex> hole;
  for (const GapIndex c : gap_.cells_at(merge.from))
    if (gap_.cell(c).has(merge.into) || moved(c, merge).quality < least_to_yield) hole.push_back(c);
  gap_.move(merge.into, before);
  return hole;
}

bool GapCloser::close(const VertexMerge& merge) {
  if (!suits_chosen(merge)) return false;
  const std::vector<GapIndex> hole = hole_of(merge);
  if (hole.empty()) return false;
  if (fill(merge, hole)) return true;
  std::vector<GapIndex> around(gap_.cells_at(merge.from).begin(), gap_.cells_at(merge.from).end());
  if (around.size() > hole.size() && fill(merge, around)) return true;
  std::vector<GapIndex> wide = hole;
  for (const GapIndex c : hole)
    for (const Vertex v : gap_.cell(c).vertices())
      for (const GapIndex other : gap_.cells_at(v))
        if (gap_.cell(c).count_common(gap_.cell(other)) >= 3) wide.push_back(other);
  sort_unique(wide);
  if (wide.size() > hole.size() && fill(merge, wide)) return true;
  around.insert(around.end(), gap_.cells_at(merge.into).begin(), gap_.cells_at(merge.into).end());
  sort_unique(around);
  return fill(merge, around);
}

// The room is filled anew; the other cells at merge.from get the other vertex.
bool GapCloser::fill(const VertexMerge& merge, std::span<const GapIndex> room) {
  std::vector<GapIndex> out(room.begin(), room.end());
  out.insert(out.end(), gap_.cells_at(merge.from).begin(), gap_.cells_at(merge.from).end());
  sort_unique(out);
  const Vec3 before = gap_.points()[merge.into];
  gap_.move(merge.into, merge.at);
  std::vector<GapCell> in;
  double most = worth_of(gap_, out).cost + slack;
  for (const GapIndex c : out) {
    if (std::ranges::find(room, c) != room.end()) continue;
    in.push_back(moved(c, merge));
    most -= cost_of(std::max(hoped_for, in.back().quality));
  }
  const auto filling = refill_.find_merged(room, merge.from, merge.into, least_to_yield, most);
  gap_.move(merge.into, before);
  if (!filling) return false;
  in.insert(in.end(), filling->begin(), filling->end());
  return carry_out(merge, out, std::move(in));
}

bool GapCloser::carry_out(const VertexMerge& merge, std::span<const GapIndex> out, std::vector<GapCell> in) {
  for (GapCell& cell : in) cell = gap_.make(cell.kind, cell.corners, cell.region);
  std::vector<Vertex> moving;
  for (const GapIndex c : out)
    for (const Vertex v : gap_.cell(c).vertices())
      if (v != merge.from && gap_.is_inside(v)) moving.push_back(v);
  const bool moves = merge.is_fixed || gap_.is_inside(merge.into);
  if (moves) moving.push_back(merge.into);
  sort_unique(moving);
  const Replacement replacement{out, in, worth_of(gap_, out).floor, std::span(&merge, 1)};
  patch_.take(moving, replacement);
  if (moves) patch_.place(merge.into, merge.at);
  patch_.raise(goal, rounds_of_closing);
  if (!patch_.keeps_floors() || !patch_.costs_at_most(patch_.cost_before() - least_gain)) return false;
  patch_.carry_out(gap_, replacement);
  return true;
}

}  // namespace hexpipe::assemble::gap
