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

// The corners of a triangle, or the ends of a segment, of which the second stands twice.
using Simplex = std::array<Vec3, 3>;

inline Vec3 point_of(const Simplex& simplex, const Weights& w) {
  return w[0] * simplex[0] + w[1] * simplex[1] + w[2] * simplex[2];
}

Weights nearest_weights(const Simplex& simplex, const Vec3& to);

class SimplexTree {
 public:
  explicit SimplexTree(std::vector<Simplex> simplices);

  bool empty() const { return simplices_.empty(); }
  // The distance to the nearest simplex, or `most` if none is nearer.
  double distance(const Vec3& to, double most) const;
  // The simplices up to `reach` away, ascending.
  std::vector<std::int32_t> within(const Vec3& to, double reach) const;
  const Simplex& simplex(std::int32_t i) const { return simplices_[static_cast<std::size_t>(i)]; }

 private:
  double distance_to(std::int32_t simplex, const Vec3& to) const;

  std::vector<Simplex> simplices_;
  BoxTree tree_;
};

}  // namespace hexpipe::fitcad
