#pragma once
// Corrects distances along a field so that they add up around loops.

#include <span>
#include <vector>

#include "tools/tetmesh/fields/loops.hpp"

namespace hexpipe::tetmesh::fields {

struct CurlLimits {
  float stiffness;  // the weight of the squared corrections, against the squares of what is missing around loops
  int most_iterations;
  double tolerance;  // the residual at which the solver ends, as a share of that at the start
  // Where a correction is more than this share of its link's length, the stiffness grows in proportion, in so many
  // further rounds: what is missing is shared out among more links, so that no rows are squeezed or drawn apart more
  // than others.
  double soft_strain = 0;
  int rounds = 0;
};

// The smallest correction of the distances (least squares) that closes every loop, as far as the stiffness lets it. The
// distances are those along the K axes of links, link after link. It is fastest where the loops for the K axes follow
// each other. `lengths` of links, in the unit of the distances, are asked for by rounds alone.
template <std::size_t K>
std::vector<float> curl_correction(std::span<const float> distances, const Loops& loops, const CurlLimits& limits,
                                   std::span<const float> lengths = {});

}  // namespace hexpipe::tetmesh::fields
