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
  // After the first solution, the problem is solved again in so many rounds. In these, a correction of more than
  // soft_strain of its link's length counts more, in proportion.
  int rounds = 0;
  double soft_strain = 0;
  bool keeps_scale = false;  // in rounds, too: distances stay as long in the mean as they were
};

// The smallest correction of the distances (least squares) that closes every loop, as far as the stiffness lets it. The
// distances are those along the K axes of links, link after link. It is fastest where the loops for the K axes follow
// each other. Rounds need the lengths of all links, in the unit of the distances.
template <std::size_t K>
std::vector<float> curl_correction(std::span<const float> distances, const Loops& loops, const CurlLimits& limits,
                                   std::span<const float> lengths = {});

}  // namespace hexpipe::tetmesh::fields
