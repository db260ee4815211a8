#include "tools/findhex/quads.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace hexpipe {
namespace {

// The angles are a filter before the test of the corners, so its rounding must not reject what that one accepts.
constexpr double filter_slack = 1 - 1e-9;

}  // namespace

void QuadAngle::find_opposites(const VertexLinks& links, std::vector<Vertex>& found) const {
  found.clear();
  const auto neighbours = links.neighbours_of(corner_);
  links.for_each_linked_to_both(corner_, place_, other_place_, [&](int p) { found.push_back(neighbours[p]); });
  if (!sides_are_linked_) return;

  const bool both = !found.empty();
  const auto beside = links.neighbours_of(side_);
  links.for_each_linked(side_, links.place_of(other_side_, side_), [&](int p) {
    if (beside[p] != corner_) found.push_back(beside[p]);
  });
  if (!both) return;
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

bool has_unfolded_diagonal(const TetMesh& mesh, const VertexLinks& links, Vertex a, Vertex b, Vertex c, Vertex d) {
  const Vec3 &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c], &s = mesh.points[d];
  return (!is_folded(p, q, r, s) && links.is_facet(a, b, c) && links.is_facet(a, c, d)) ||
         (!is_folded(q, r, s, p) && links.is_facet(b, c, d) && links.is_facet(b, d, a));
}

void QuadFan::find(Vertex least) {
  opposites_.clear();
  pairs_.clear();
  const auto neighbours = links_.neighbours_of(least);
  const int first =
      static_cast<int>(std::upper_bound(neighbours.begin(), neighbours.end(), least) - neighbours.begin());
  const int count = static_cast<int>(neighbours.size());
  for (int place = first; place < count; ++place)
    links_.for_each_within_two_links(least, place, first, [&](int other_place) {
      if (angle_suffices(mesh_.points[neighbours[place]] - mesh_.points[least],
                         mesh_.points[neighbours[other_place]] - mesh_.points[least]))
        find_between(least, place, other_place);
    });
  file_pairs(neighbours.size());
}

void QuadFan::find_between(Vertex least, int place, int other_place) {
  const auto neighbours = links_.neighbours_of(least);
  const Vertex side = neighbours[place], other_side = neighbours[other_place];
  const auto begin = static_cast<std::int32_t>(opposites_.size());
  QuadAngle(links_, least, place, other_place).find_opposites(links_, found_);
  for (const Vertex opposite : found_)
    if (is_wanted(least, side, opposite, other_side)) opposites_.push_back(opposite);
  const auto end = static_cast<std::int32_t>(opposites_.size());
  if (begin < end) pairs_.push_back({place, other_place, begin, end});
}

// Each pair is filed under both; pairs ascend, so the partners do.
void QuadFan::file_pairs(std::size_t neighbour_count) {
  offsets_.assign(neighbour_count + 1, 0);
  for (const Pair& pair : pairs_) {
    ++offsets_[pair.place];
    ++offsets_[pair.other_place];
  }
  std::exclusive_scan(offsets_.begin(), offsets_.end(), offsets_.begin(), 0);
  partners_.resize(2 * pairs_.size());
  for (const Pair& pair : pairs_) partners_[offsets_[pair.other_place]++] = {pair.place, pair.begin, pair.end};
  for (const Pair& pair : pairs_) partners_[offsets_[pair.place]++] = {pair.other_place, pair.begin, pair.end};
  std::copy_backward(offsets_.begin(), offsets_.end() - 1, offsets_.end());
  offsets_.front() = 0;
}

bool QuadFan::is_wanted(Vertex least, Vertex side, Vertex opposite, Vertex other_side) const {
  if (opposite < least) return false;
  const std::array<Vec3, 4> p{mesh_.points[least], mesh_.points[side], mesh_.points[opposite],
                              mesh_.points[other_side]};
  const std::array<Vec3, 4> edges{p[1] - p[0], p[2] - p[1], p[3] - p[2], p[0] - p[3]};
  for (std::size_t i = 0; i < 3; ++i)
    if (!angle_suffices(edges[i], edges[i + 1])) return false;
  return !filter_.drop_folded || has_unfolded_diagonal(mesh_, links_, least, side, opposite, other_side);
}

bool QuadFan::angle_suffices(const Vec3& u, const Vec3& v) const {
  const double least = filter_.min_quality * filter_.min_quality * filter_slack;
  return norm_squared(cross(u, v)) >= least * norm_squared(u) * norm_squared(v);
}

std::span<const Vertex> QuadFan::opposites(int place, int other_place) const {
  for (const Partner& partner : partners_of(place))
    if (partner.place == other_place) return std::span(opposites_).subspan(partner.begin, partner.end - partner.begin);
  return {};
}

}  // namespace hexpipe
