// Scaled Jacobians and volumes. The minimum over an element is found by branch and bound on the element cut into parts,
// each an element of the same kind: A. Johnen, J.-C. Weill, J.-F. Remacle, Robust and efficient validation of the
// linear hexahedral element (IMR 2017), section 4. Where they bound the lengths of the tangents by constants on each
// part, here the product of the lengths is bounded from above by a polynomial of the Jacobian's own degrees: a tangent
// is linear along each parameter, so its length is convex and lies below the interpolation between its ends. Where
// Jacobian >= q lengths holds coefficient by coefficient in Bezier form, the scaled Jacobian is at least q. Both sides
// agree at the corners, so that most cells need no cut at all.

#include "common/mesh/quality.hpp"

#include <algorithm>
#include <limits>

#include "common/mesh/jacobian.hpp"

namespace hexpipe {
namespace {

// Parts get smaller than any feature of a cell; the gap between the bounds shrinks with the square of their size.
constexpr int max_cuts = 12;

template <class Topology>
using Corners = std::array<Vec3, Topology::corner_count>;

// The least scaled Jacobian of a part is at least `lower` (where the Jacobian is positive); `upper` is attained at one
// of its corners.
struct Bounds {
  double lower = std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

double ratio(double jacobian, double lengths) {
  return lengths > 0 ? jacobian / lengths : 0;
}

Bounds bounds_of(const Corners<HexTopology>& p) {
  const HexTangents<Vec3> t(p);
  const HexJacobian<Vec3> jacobian(t);
  double length_i[2][2], length_j[2][2], length_k[2][2];
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      length_i[a][b] = norm(t.along_i[a][b]);
      length_j[a][b] = norm(t.along_j[a][b]);
      length_k[a][b] = norm(t.along_k[a][b]);
    }

  // Two of the three factors depend on each parameter, so that a coefficient is a mean over the ways to split its
  // index.
  double lengths[27] = {};
  constexpr double ways[3] = {1, 0.5, 1};
  for (int bits = 0; bits < 64; ++bits) {
    const int i1 = bits & 1, i2 = bits >> 1 & 1, j1 = bits >> 2 & 1, j2 = bits >> 3 & 1, k1 = bits >> 4 & 1,
              k2 = bits >> 5;
    lengths[9 * (i1 + i2) + 3 * (j1 + j2) + k1 + k2] +=
        ways[i1 + i2] * ways[j1 + j2] * ways[k1 + k2] * (length_i[j1][k1] * length_j[i1][k2] * length_k[i2][j2]);
  }

  Bounds bounds;
  const auto coefficients = jacobian.bezier();
  for (int c = 0; c < 27; ++c) bounds.lower = std::min(bounds.lower, ratio(coefficients[c] / 8, lengths[c]));
  for (int a = 0; a < 3; a += 2)
    for (int b = 0; b < 3; b += 2)
      for (int c = 0; c < 3; c += 2) {
        const int corner = 9 * a + 3 * b + c;
        bounds.upper = std::min(bounds.upper, ratio(coefficients[corner] / 8, lengths[corner]));
      }
  return bounds;
}

// The Jacobian is the same for each two sides of the triangle; the lengths are not.
Bounds bounds_of(const Corners<PrismTopology>& p) {
  double side[3][2], up[3];
  for (int i = 0; i < 3; ++i) {
    side[i][0] = norm(p[(i + 1) % 3] - p[i]);
    side[i][1] = norm(p[3 + (i + 1) % 3] - p[3 + i]);
    up[i] = norm(p[3 + i] - p[i]);
  }
  const auto jacobian = prism_bezier<Vec3>(p);
  Bounds bounds;
  for (int s = 0; s < 3; ++s) {
    const double *a = side[s], *b = side[(s + 1) % 3];
    const double area[3] = {a[0] * b[0], (a[0] * b[1] + a[1] * b[0]) / 2, a[1] * b[1]};
    for (int i = 0; i < 3; ++i)
      for (int level = 0; level < 3; ++level) {
        const double value = ratio(jacobian[i][level] / 2, area[level] * up[i]);
        bounds.lower = std::min(bounds.lower, value);
        if (level != 1) bounds.upper = std::min(bounds.upper, value);
      }
  }
  return bounds;
}

// At every height the tangents of the base and the direction to the apex are the base's, up to their lengths: what is
// left is a function of the place in the base, with a bilinear Jacobian.
Bounds bounds_of(const Corners<PyramidTopology>& p) {
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

  double jacobians[9] = {}, lengths[9] = {};
  constexpr double ways[3] = {1, 0.5, 1};
  for (int bits = 0; bits < 16; ++bits) {
    const int i1 = bits & 1, i2 = bits >> 1 & 1, j1 = bits >> 2 & 1, j2 = bits >> 3;
    const int index = 3 * (i1 + i2) + j1 + j2;
    const double way = ways[i1 + i2] * ways[j1 + j2];
    jacobians[index] += way * jacobian[i2][j2];
    lengths[index] += way * (length_i[j1] * length_j[i1] * length_p[i2][j2]);
  }

  Bounds bounds;
  for (int c = 0; c < 9; ++c) bounds.lower = std::min(bounds.lower, ratio(jacobians[c], lengths[c]));
  for (const int corner : {0, 2, 6, 8})
    bounds.upper = std::min(bounds.upper, ratio(jacobians[corner], lengths[corner]));
  return bounds;
}

void refine(const auto& part, double lower, int cuts, double& least) {
  if (lower >= least - quality_tolerance || least <= 0 || cuts == max_cuts) return;
  const auto parts = split(part);
  std::array<double, parts.size()> lowers;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Bounds bounds = bounds_of(parts[i]);
    lowers[i] = bounds.lower;
    least = std::min(least, bounds.upper);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) refine(parts[i], lowers[i], cuts + 1, least);
}

template <class Topology>
Corners<Topology> corners_of(std::span<const Vec3> corners) {
  Corners<Topology> result;
  std::copy_n(corners.begin(), result.size(), result.begin());
  return result;
}

}  // namespace

double least_corner_scaled_jacobian(CellKind kind, std::span<const Vec3> corners) {
  return with_topology(kind, [&]<class Topology>(Topology) {
    double least = std::numeric_limits<double>::infinity();
    for (const LocalCorner& c : Topology::corners) {
      const Vec3& o = corners[c[0]];
      least = std::min(least, scaled_jacobian(corners[c[1]] - o, corners[c[2]] - o, corners[c[3]] - o));
    }
    return least;
  });
}

double least_scaled_jacobian(CellKind kind, std::span<const Vec3> corners) {
  return with_topology(kind, [&]<class Topology>(Topology) {
    double least = least_corner_scaled_jacobian(kind, corners);
    if constexpr (Topology::kind != CellKind::tet) {
      const auto whole = corners_of<Topology>(corners);
      const Bounds bounds = bounds_of(whole);
      least = std::min(least, bounds.upper);
      refine(whole, bounds.lower, 0, least);
    }
    return least;
  });
}

// The sum of the tets from corner 0 to the facets. A bilinear quad encloses the mean of its two triangulations.
double cell_volume(CellKind kind, std::span<const Vec3> corners) {
  return with_topology(kind, [&]<class Topology>(Topology) {
    auto tet = [&](int a, int b, int c) {
      return det(corners[a] - corners[0], corners[b] - corners[0], corners[c] - corners[0]);
    };
    double triangles = 0, quads = 0;
    for (const LocalTriangle& t : Topology::triangles) triangles += tet(t[0], t[1], t[2]);
    for (const LocalQuad& q : Topology::quads)
      quads += tet(q[0], q[1], q[2]) + tet(q[0], q[2], q[3]) + tet(q[0], q[1], q[3]) + tet(q[1], q[2], q[3]);
    return triangles / 6 + quads / 12;
  });
}

}  // namespace hexpipe
