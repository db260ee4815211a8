#pragma once
// Triangles and straight pieces of lines, and which of them is the nearest to a point.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe::fitcad {

// A point of a triangle, as weights of its corners.
using Weights = std::array<double, 3>;

// The corners of a triangle; a piece of a line repeats its end.
using Piece = std::array<Vec3, 3>;

inline Vec3 point_of(const Piece& piece, const Weights& w) {
  return w[0] * piece[0] + w[1] * piece[1] + w[2] * piece[2];
}

Weights nearest_weights(const Piece& piece, const Vec3& to);

class PieceTree {
 public:
  explicit PieceTree(std::vector<Piece> pieces);

  bool empty() const { return pieces_.empty(); }
  // The distance to the nearest piece, or `most` if none is nearer.
  double distance(const Vec3& to, double most) const;
  // The pieces up to `reach` away, ascending.
  std::vector<std::int32_t> within(const Vec3& to, double reach) const;
  const Piece& piece(std::int32_t i) const { return pieces_[static_cast<std::size_t>(i)]; }

 private:
  double distance_to(std::int32_t piece, const Vec3& to) const;

  std::vector<Piece> pieces_;
  BoxTree tree_;
};

}  // namespace hexpipe::fitcad
