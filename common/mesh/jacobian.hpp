#pragma once
// The Jacobian determinants of hexes and prisms as polynomials in Bezier form. They work for any vectors that have -, +
// and det: doubles for quality, integers for the exact test of validity.
//
// A. Johnen, J.-C. Weill, J.-F. Remacle: Robust and efficient validation of the linear hexahedral element (IMR 2017),
// section 3: the Jacobian of a trilinear hex is triquadratic and follows from 20 determinants.

#include <array>

namespace hexpipe {

// The corner of a hex at parameters (i, j, k): i along 01, j along 03, k along 04.
inline constexpr int hex_corner_at[2][2][2] = {{{0, 4}, {3, 7}}, {{1, 5}, {2, 6}}};

// The twelve edge vectors of a hex, by direction. The two indices are the other two parameters, in the order i, j, k.
template <class Vector>
struct HexTangents {
  Vector along_i[2][2], along_j[2][2], along_k[2][2];

  template <class Points>
  explicit HexTangents(const Points& p) {
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        along_i[a][b] = p[hex_corner_at[1][a][b]] - p[hex_corner_at[0][a][b]];
        along_j[a][b] = p[hex_corner_at[a][1][b]] - p[hex_corner_at[a][0][b]];
        along_k[a][b] = p[hex_corner_at[a][b][1]] - p[hex_corner_at[a][b][0]];
      }
  }
};

template <class Vector>
class HexJacobian {
 public:
  using Number = decltype(det(Vector{}, Vector{}, Vector{}));

  explicit HexJacobian(const HexTangents<Vector>& t) {
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        corner_[0][a][b] = det(t.along_i[a][b], t.along_j[0][b], t.along_k[0][a]);
        corner_[1][a][b] = det(t.along_i[a][b], t.along_j[1][b], t.along_k[1][a]);
        edge_[0][a][b] = det(t.along_i[a][b], t.along_j[0][b] + t.along_j[1][b], t.along_k[0][a] + t.along_k[1][a]);
        edge_[1][a][b] = det(t.along_i[0][b] + t.along_i[1][b], t.along_j[a][b], t.along_k[a][0] + t.along_k[a][1]);
        edge_[2][a][b] = det(t.along_i[b][0] + t.along_i[b][1], t.along_j[a][0] + t.along_j[a][1], t.along_k[a][b]);
      }
  }

  // At corner (i, j, k).
  const Number& at_corner(int i, int j, int k) const { return corner_[i][j][k]; }

  // True if test(value) holds for the Jacobian at the 8 corners and for 4 times the Jacobian at the 12 midpoints of
  // edges.
  template <class Test>
  bool all_determinants(Test&& test) const {
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b)
        if (!test(corner_[0][a][b]) || !test(corner_[1][a][b]) || !test(edge_[0][a][b]) || !test(edge_[1][a][b]) ||
            !test(edge_[2][a][b]))
          return false;
    return true;
  }

  // 8 times the 27 Bezier coefficients (the factor 8 keeps integers whole); their index is 9 i + 3 j + k.
  std::array<Number, 27> bezier() const {
    std::array<Number, 27> b;
    Number corners_of_face[3][2]{}, edges_of_face[3][2]{}, all_corners{}, all_edges{};
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        for (int k = 0; k < 2; ++k) {
          const Number& corner = corner_[i][j][k];
          b[index(2 * i, 2 * j, 2 * k)] = 8 * corner;
          corners_of_face[0][i] += corner;
          corners_of_face[1][j] += corner;
          corners_of_face[2][k] += corner;
          all_corners += corner;
        }
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q) {
        b[index(1, 2 * p, 2 * q)] = edge_coefficient(edge_[0][p][q], corner_[0][p][q], corner_[1][p][q]);
        b[index(2 * p, 1, 2 * q)] = edge_coefficient(edge_[1][p][q], corner_[p][0][q], corner_[p][1][q]);
        b[index(2 * p, 2 * q, 1)] = edge_coefficient(edge_[2][p][q], corner_[p][q][0], corner_[p][q][1]);
        for (int axis = 0; axis < 3; ++axis) all_edges += edge_[axis][p][q];
        edges_of_face[0][p] += edge_[1][p][q] + edge_[2][p][q];
        edges_of_face[1][p] += edge_[0][p][q];
        edges_of_face[1][q] += edge_[2][p][q];
        edges_of_face[2][q] += edge_[0][p][q] + edge_[1][p][q];
      }
    for (int side = 0; side < 2; ++side) {
      b[index(2 * side, 1, 1)] = 2 * edges_of_face[0][side] - 6 * corners_of_face[0][side];
      b[index(1, 2 * side, 1)] = 2 * edges_of_face[1][side] - 6 * corners_of_face[1][side];
      b[index(1, 1, 2 * side)] = 2 * edges_of_face[2][side] - 6 * corners_of_face[2][side];
    }
    b[index(1, 1, 1)] = all_edges - 5 * all_corners;
    return b;
  }

 private:
  static constexpr int index(int i, int j, int k) { return 9 * i + 3 * j + k; }
  static Number edge_coefficient(const Number& edge, const Number& a, const Number& b) {
    return 4 * edge - 4 * (a + b);
  }

  Number corner_[2][2][2];
  Number edge_[3][2][2];  // [direction][the two other parameters, in order], times 4
};

// The Jacobian of a prism is linear over the triangle and quadratic along the three edges 03, 14, 25. Returns 2 times
// the Bezier coefficients, [edge][from bottom to top].
template <class Vector, class Points>
auto prism_bezier(const Points& p) {
  const Vector a0 = p[1] - p[0], b0 = p[2] - p[0], a1 = p[4] - p[3], b1 = p[5] - p[3];
  using Number = decltype(det(a0, b0, a1));
  std::array<std::array<Number, 3>, 3> b;
  for (int i = 0; i < 3; ++i) {
    const Vector up = p[i + 3] - p[i];
    b[i] = {2 * det(a0, b0, up), det(a0, b1, up) + det(a1, b0, up), 2 * det(a1, b1, up)};
  }
  return b;
}

// Cut cells into subcells of the same kind by halving their parameters; a subcell is again exactly such a cell.
// Coordinates are multiplied by 8 (hex) or 4 (prism, pyramid) to keep integers whole; signs and scaled Jacobians stay
// the same.

template <class Vector>
std::array<std::array<Vector, 8>, 8> split(const std::array<Vector, 8>& p) {
  Vector grid[3][3][3];
  for (int c = 0; c < 8; ++c)
    grid[2 * (c & 1)][2 * (c >> 1 & 1)][2 * (c >> 2)] = p[hex_corner_at[c & 1][c >> 1 & 1][c >> 2]];
  const auto halve = [](Vector& low, Vector& middle, Vector& high) {
    middle = low + high;
    low = low + low;
    high = high + high;
  };
  for (int j = 0; j < 3; j += 2)
    for (int k = 0; k < 3; k += 2) halve(grid[0][j][k], grid[1][j][k], grid[2][j][k]);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; k += 2) halve(grid[i][0][k], grid[i][1][k], grid[i][2][k]);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) halve(grid[i][j][0], grid[i][j][1], grid[i][j][2]);
  std::array<std::array<Vector, 8>, 8> subcells;
  for (int subcell = 0; subcell < 8; ++subcell)
    for (int c = 0; c < 8; ++c) {
      const int a = c & 1, b = c >> 1 & 1, d = c >> 2;
      subcells[subcell][hex_corner_at[a][b][d]] = grid[(subcell & 1) + a][(subcell >> 1 & 1) + b][(subcell >> 2) + d];
    }
  return subcells;
}

template <class Vector>
std::array<std::array<Vector, 6>, 8> split(const std::array<Vector, 6>& p) {
  // The corners of the triangle, then the middles of 01, 12, 20, each as the sum of two corners.
  constexpr int node[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
  constexpr int triangle[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  auto point = [&](int n, int level) {
    const Vector bottom = p[node[n][0]] + p[node[n][1]], top = p[3 + node[n][0]] + p[3 + node[n][1]];
    return (2 - level) * bottom + level * top;
  };
  std::array<std::array<Vector, 6>, 8> subcells;
  for (int subcell = 0; subcell < 8; ++subcell)
    for (int c = 0; c < 6; ++c) subcells[subcell][c] = point(triangle[subcell % 4][c % 3], subcell / 4 + c / 3);
  return subcells;
}

template <class Vector>
std::array<std::array<Vector, 5>, 4> split(const std::array<Vector, 5>& p) {
  constexpr int at[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};  // the parameters of the base's corners
  constexpr int weight[3][2] = {{2, 0}, {1, 1}, {0, 2}};
  std::array<std::array<Vector, 5>, 4> subcells;
  for (int subcell = 0; subcell < 4; ++subcell) {
    for (int c = 0; c < 4; ++c) {
      const int i = at[subcell][0] + at[c][0], j = at[subcell][1] + at[c][1];
      Vector sum{};
      for (int q = 0; q < 4; ++q) sum = sum + weight[i][at[q][0]] * weight[j][at[q][1]] * p[q];
      subcells[subcell][c] = sum;
    }
    subcells[subcell][4] = 4 * p[4];
  }
  return subcells;
}

}  // namespace hexpipe
