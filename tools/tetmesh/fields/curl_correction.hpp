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
};

// The smallest correction of the distances (least squares) that closes every loop, as far as the stiffness lets it. The
// distances are those along the K axes of links, link after link. It is fastest where the loops for the K axes follow
// each other.
template <std::size_t K>
std::vector<float> curl_correction(std::span<const float> distances, const Loops& loops, const CurlLimits& limits);

}  // namespace hexpipe::tetmesh::fields
