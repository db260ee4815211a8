#pragma once
// Triangles and segments, and which of them is the nearest to a point.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe::fitcad {

// A point of a triangle, as weights of its corners.
using Weights = std::array<double, 3>;

// The corners of a triangle; or the ends of a segment, the second one twice.
using Simplex = std::array<Vec3, 3>;

inline Vec3 point_of(const Simplex& simplex, const Weights& w) {
  return w[0] * simplex[0] + w[1] * simplex[1] + w[2] * simplex[2];
}

// The weights of the point of the simplex that is nearest to `to`. They are at least 0 and sum to 1.
Weights nearest_weights(const Simplex& simplex, const Vec3& to);

class SimplexTree {
 public:
  explicit SimplexTree(std::vector<Simplex> simplices);

  bool empty() const { return simplices_.empty(); }
  // The distance to the nearest simplex; `most` if all are further away than that.
  double distance(const Vec3& to, double most) const;
  // The numbers of the simplices at most `reach` away, ascending.
  std::vector<std::int32_t> within(const Vec3& to, double reach) const;
  const Simplex& simplex(std::int32_t i) const { return simplices_[static_cast<std::size_t>(i)]; }

 private:
  double distance_to(std::int32_t simplex, const Vec3& to) const;

  std::vector<Simplex> simplices_;
  BoxTree tree_;
};

}  // namespace hexpipe::fitcad
