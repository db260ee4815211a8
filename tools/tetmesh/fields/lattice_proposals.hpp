#pragma once
// Points of a lattice, as nodes propose them: each node sees those around it, and nodes that see the same point agree
// on its place. A Proposal has a place() and a `trust`.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "common/mesh/vec3.hpp"
#include "common/run/parallel.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"

namespace hexpipe::tetmesh::fields {

// Proposals within this distance of each other, in sizes, are the same point.
inline constexpr double same_point = 0.3;

// A node trusts points of the lattice less with their distance, in cells.
inline double trust_at(double distance) {
  return 1.5 - distance;
}

// Calls body(cells, distance) for the points of the lattice that are at most `furthest` cells from a node with these
// coordinates: the cells to the point along each axis, and the most of these.
template <std::size_t K, class Body>
void for_each_point_around(const std::array<double, K>& coordinates, double furthest, Body&& body) {
  constexpr int count = K == 2 ? 9 : 27;
  for (int cell = 0; cell < count; ++cell) {
    std::array<double, K> cells;
    double distance = 0;
    for (int k = 0, rest = cell; k < static_cast<int>(K); ++k, rest /= 3) {
      cells[k] = rest % 3 - 1 - coordinates[k];
      distance = std::max(distance, std::abs(cells[k]));
    }
    if (distance <= furthest) body(cells, distance);
  }
}

// Finds the proposals of one point. They must outlive it.
template <class Proposal>
class ProposalIndex {
 public:
  // size_of(proposal) may be too large. The grid begins at the origin.
  template <class Size>
  ProposalIndex(const std::vector<Proposal>& proposals, const Vec3& origin, Size&& size_of)
      : proposals_(proposals), grid_(origin) {
    for (const Proposal& p : proposals) grid_.add(p.place(), 2 * same_point * size_of(p));
  }

  // Calls body(proposal) for those within same_point of a place with this size. No size there is below `least_size`.
  template <class Body>
  void for_each_at(const Vec3& place, double size, double least_size, Body&& body) const {
    const double reach = same_point * size;
    grid_.for_each_near(place, reach, 2 * same_point * least_size, [&](std::int32_t i) {
      const Proposal& other = proposals_[i];
      if (norm_squared(other.place() - place) <= reach * reach) body(other);
      return true;
    });
  }

 private:
  const std::vector<Proposal>& proposals_;
  geometry::SizedPointGrid grid_;
};

// Vectors, each as often as it is trusted.
struct TrustedSum {
  Vec3 sum;
  double trust = 0;

  void add(double trusted, const Vec3& v) {
    sum += trusted * v;
    trust += trusted;
  }
};

// Replaces each proposal by agreed(index of all, proposal), and puts the most trusted first.
template <class Proposal, class Size, class Agreed>
void agree(const Vec3& origin, Size&& size_of, Agreed&& agreed, std::vector<Proposal>& proposals) {
  const ProposalIndex<Proposal> index(proposals, origin, size_of);
  std::vector<Proposal> result(proposals.size());
  parallel_for(static_cast<std::int64_t>(result.size()), 256,
               [&](std::int64_t i) { result[i] = agreed(index, proposals[i]); });
  std::ranges::stable_sort(result, std::greater(), &Proposal::trust);
  proposals = std::move(result);
}

}  // namespace hexpipe::tetmesh::fields
