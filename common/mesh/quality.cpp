// Scaled Jacobians and volumes. The minimum over an element is found by branch and bound, which cuts the element into
// subcells of the same kind: A. Johnen, J.-C. Weill, J.-F. Remacle, Robust and efficient validation of the linear
// hexahedral element (IMR 2017), section 4. They bound the lengths of the tangents by constants on each subcell. Here a
// polynomial of the Jacobian's own degrees bounds the product of the lengths from above: a tangent is linear along each
// parameter, so its length is convex and lies below the interpolation between its ends. If Jacobian >= q * lengths
// holds for each coefficient of the Bezier form, the scaled Jacobian is at least q. Both sides agree at the corners, so
// most cells need no cut at all.

#include "common/mesh/quality.hpp"

#include <algorithm>
#include <limits>

#include "common/mesh/cell_measures.hpp"
#include "common/mesh/jacobian.hpp"

namespace hexpipe {
namespace {

// Subcells then are smaller than any feature of a cell. The gap that a cut leaves shrinks with the square of their
// size.
constexpr int max_cuts = 36;

template <class Topology>
using Corners = std::array<Vec3, Topology::corner_count>;

// The Jacobian of a subcell, and an upper bound of the product of its tangents' lengths, as Bezier coefficients. The
// coefficients in `corners` are the exact values at corners.
template <std::size_t Count, std::size_t CornerCount>
struct Bounds {
  std::array<double, Count> jacobian, lengths;
  std::array<int, CornerCount> corners;
};

// The coefficients of a product of two linear functions are means over the ways to split the index.
constexpr double ways[3] = {1, 0.5, 1};

Bounds<27, 8> bounds_of(const Corners<HexTopology>& p) {
  const HexTangents<Vec3> t(p);
  double length_i[2][2], length_j[2][2], length_k[2][2];
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      length_i[a][b] = norm(t.along_i[a][b]);
      length_j[a][b] = norm(t.along_j[a][b]);
      length_k[a][b] = norm(t.along_k[a][b]);
    }

  Bounds<27, 8> bounds{HexJacobian<Vec3>(t).bezier(), {}, {0, 2, 6, 8, 18, 20, 24, 26}};
  for (double& jacobian : bounds.jacobian) jacobian /= 8;
  // Each parameter occurs in two of the three factors. First multiply the two that have i, then the third.
  for (int jk = 0; jk < 4; ++jk) {
    const int j2 = jk & 1, k2 = jk >> 1;
    double product[3] = {};
    for (int i = 0; i < 4; ++i) product[(i & 1) + (i >> 1)] += length_j[i & 1][k2] * length_k[i >> 1][j2];
    for (int j1k1 = 0; j1k1 < 4; ++j1k1) {
      const int j = (j1k1 & 1) + j2, k = (j1k1 >> 1) + k2;
      const double factor = ways[j] * ways[k] * length_i[j1k1 & 1][j1k1 >> 1];
      for (int i = 0; i < 3; ++i) bounds.lengths[9 * i + 3 * j + k] += ways[i] * factor * product[i];
    }
  }
  return bounds;
}

// The Jacobian is the same for any two sides of the triangle; the lengths are not.
Bounds<27, 18> bounds_of(const Corners<PrismTopology>& p) {
  double side[3][2], up[3];
  for (int i = 0; i < 3; ++i) {
    side[i][0] = norm(p[(i + 1) % 3] - p[i]);
    side[i][1] = norm(p[3 + (i + 1) % 3] - p[3 + i]);
    up[i] = norm(p[3 + i] - p[i]);
  }
  const auto jacobian = prism_bezier<Vec3>(p);
  Bounds<27, 18> bounds{};
  std::size_t next_corner = 0;
  for (int s = 0; s < 3; ++s) {
    const double *a = side[s], *b = side[(s + 1) % 3];
    const double area[3] = {a[0] * b[0], (a[0] * b[1] + a[1] * b[0]) / 2, a[1] * b[1]};
    for (int i = 0; i < 3; ++i)
      for (int level = 0; level < 3; ++level) {
        const int index = 9 * s + 3 * i + level;
        bounds.jacobian[index] = jacobian[i][level] / 2;
        bounds.lengths[index] = area[level] * up[i];
        if (level != 1) bounds.corners[next_corner++] = index;
      }
  }
  return bounds;
}

// At every height, the tangents and the direction to the apex are those of the base, up to their lengths. That leaves a
// function of the place in the base, with a bilinear Jacobian.
Bounds<9, 4> bounds_of(const Corners<PyramidTopology>& p) {
  constexpr int corner_at[2][2] = {{0, 3}, {1, 2}};
  double jacobian[2][2], length_p[2][2], length_i[2], length_j[2];
  for (const LocalCorner& c : PyramidTopology::corners) {
    const Vec3& o = p[c[0]];
    const int i = c[0] == 1 || c[0] == 2, j = c[0] >= 2;
    jacobian[i][j] = det(p[c[1]] - o, p[c[2]] - o, p[c[3]] - o);
    length_p[i][j] = norm(p[4] - o);
  }
  for (int a = 0; a < 2; ++a) {
    length_i[a] = norm(p[corner_at[1][a]] - p[corner_at[0][a]]);
    length_j[a] = norm(p[corner_at[a][1]] - p[corner_at[a][0]]);
  }

  Bounds<9, 4> bounds{{}, {}, {0, 2, 6, 8}};
  for (int bits = 0; bits < 16; ++bits) {
    const int i1 = bits & 1, i2 = bits >> 1 & 1, j1 = bits >> 2 & 1, j2 = bits >> 3;
    const int index = 3 * (i1 + i2) + j1 + j2;
    const double way = ways[i1 + i2] * ways[j1 + j2];
    bounds.jacobian[index] += way * jacobian[i2][j2];
    bounds.lengths[index] += way * (length_i[j1] * length_j[i1] * length_p[i2][j2]);
  }
  return bounds;
}

// Lowers `least` to the values at the corners of a subcell. Returns whether the subcell may have lower values inside,
// by more than the tolerance.
bool may_attain_less(const auto& subcell, double& least) {
  const auto bounds = bounds_of(subcell);
  for (const int corner : bounds.corners)
    if (bounds.jacobian[corner] < least * bounds.lengths[corner])
      least = bounds.jacobian[corner] / bounds.lengths[corner];
  for (std::size_t c = 0; c < bounds.jacobian.size(); ++c)
    if (bounds.jacobian[c] < (least - quality_tolerance) * bounds.lengths[c]) return true;
  return false;
}

// The parameter along which the tangents change most relative to their lengths. Halving it reduces the loss of the
// bound there to a quarter. Many hexes are nearly swept and need no cut along one or two parameters.
int most_bent_parameter(const Corners<HexTopology>& p) {
  const HexTangents<Vec3> t(p);
  auto bend = [](const Vec3& from, const Vec3& to) {
    return norm_squared(to - from) / std::max(std::min(norm_squared(from), norm_squared(to)), 1e-300);
  };
  double bends[3] = {};
  for (int a = 0; a < 2; ++a) {
    bends[0] += bend(t.along_j[0][a], t.along_j[1][a]) + bend(t.along_k[0][a], t.along_k[1][a]);
    bends[1] += bend(t.along_i[0][a], t.along_i[1][a]) + bend(t.along_k[a][0], t.along_k[a][1]);
    bends[2] += bend(t.along_i[a][0], t.along_i[a][1]) + bend(t.along_j[a][0], t.along_j[a][1]);
  }
  return static_cast<int>(std::max_element(bends, bends + 3) - bends);
}

std::array<Corners<HexTopology>, 2> subcells_of(const Corners<HexTopology>& p) {
  const int parameter = most_bent_parameter(p);
  std::array<Corners<HexTopology>, 2> halves{p, p};
  for (int c = 0; c < 4; ++c) {
    const int a = c & 1, b = c >> 1;
    const int low = parameter == 0   ? hex_corner_at[0][a][b]
                    : parameter == 1 ? hex_corner_at[a][0][b]
                                     : hex_corner_at[a][b][0];
    const int high = parameter == 0   ? hex_corner_at[1][a][b]
                     : parameter == 1 ? hex_corner_at[a][1][b]
                                      : hex_corner_at[a][b][1];
    halves[0][high] = halves[1][low] = 0.5 * (p[low] + p[high]);
  }
  return halves;
}
auto subcells_of(const Corners<PrismTopology>& p) {
  return split(p);
}
auto subcells_of(const Corners<PyramidTopology>& p) {
  return split(p);
}

void cut(const auto& subcell, int cuts, double& least) {
  // An invalid cell is examined no further.
  if (least <= 0 || cuts == max_cuts) return;
  const auto subcells = subcells_of(subcell);
  std::array<bool, subcells.size()> open;
  for (std::size_t i = 0; i < subcells.size(); ++i) open[i] = may_attain_less(subcells[i], least);
  for (std::size_t i = 0; i < subcells.size(); ++i)
    if (open[i]) cut(subcells[i], cuts + 1, least);
}

template <class Topology>
Corners<Topology> corners_of(std::span<const Vec3> corners) {
  Corners<Topology> result;
  std::copy_n(corners.begin(), result.size(), result.begin());
  return result;
}

}  // namespace

double least_corner_scaled_jacobian(CellKind kind, std::span<const Vec3> corners) {
  return with_topology(kind,
                       [&]<class Topology>(Topology) { return least_corner_scaled_jacobian_of<Topology>(corners); });
}

double least_scaled_jacobian(CellKind kind, std::span<const Vec3> corners) {
  return with_topology(kind, [&]<class Topology>(Topology) {
    double least = least_corner_scaled_jacobian(kind, corners);
    if constexpr (Topology::kind != CellKind::tet) {
      const auto whole = corners_of<Topology>(corners);
      if (may_attain_less(whole, least)) cut(whole, 0, least);
    }
    return least;
  });
}

double cell_volume(CellKind kind, std::span<const Vec3> corners) {
  return with_topology(kind, [&]<class Topology>(Topology) { return cell_volume_of<Topology>(corners); });
}

Vec3 cell_volume_gradient(CellKind kind, std::span<const Vec3> corners, int corner) {
  Vec3 triangles{}, quads{};
  // The facet's other corners, in its order, relative to the corner.
  const auto at = [&](const auto& facet, std::size_t i) { return corners[facet[i % facet.size()]] - corners[corner]; };
  with_topology(kind, [&]<class Topology>(Topology) {
    for (const LocalTriangle& t : Topology::triangles)
      for (std::size_t i = 0; i < t.size(); ++i)
        if (t[i] == corner) triangles += cross(at(t, i + 1), at(t, i + 2));
    for (const LocalQuad& q : Topology::quads)
      for (std::size_t i = 0; i < q.size(); ++i) {
        if (q[i] != corner) continue;
        const Vec3 b = at(q, i + 1), c = at(q, i + 2), d = at(q, i + 3);
        quads += cross(b, c + d) + cross(c, d);
      }
  });
  return (1.0 / 6) * triangles + (1.0 / 12) * quads;
}

}  // namespace hexpipe
