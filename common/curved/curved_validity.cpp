#include "common/curved/curved_validity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/curved/bernstein.hpp"
#include "common/curved/nodes.hpp"
#include "common/mesh/jacobian.hpp"
#include "common/mesh/second_order.hpp"

namespace hexpipe::curved {
namespace {

using Simplices = std::vector<BernsteinBasis::Simplex>;

constexpr std::size_t most_points = 27;          // of a hex
constexpr std::size_t most_tangents = 18;        // 2 x 3 x 3
constexpr std::size_t most_cross_products = 80;  // 4 x 4 x 5
constexpr std::size_t most_coefficients = 216;   // 6 x 6 x 6

// A coefficient of a tangent: the difference of two control points.
struct Difference {
  std::int32_t from, to;
  double factor;
};

// Tangents along the first, second and third coordinate, whose determinant is the Jacobian.
struct Tangents {
  std::array<BernsteinBasis, 3> bases;
  std::array<std::vector<Difference>, 3> differences;
};

// The derivative from the barycentric coordinate p to q of the simplex number `simplex`.
BernsteinBasis derivative_basis(const BernsteinBasis& points, std::size_t simplex) {
  Simplices simplices = points.simplices();
  --simplices[simplex].degree;
  return BernsteinBasis(std::move(simplices));
}
std::vector<Difference> derivative(const BernsteinBasis& points, const BernsteinBasis& tangent, std::size_t p,
                                   std::size_t q) {
  std::vector<Difference> differences;
  for (std::size_t i = 0; i < tangent.size(); ++i) {
    Exponents from = tangent.exponents(i), to = from;
    ++from[p], ++to[q];
    differences.push_back({points.index_of(from), points.index_of(to), 1});
  }
  return differences;
}

// The directions of a kind: the simplex, and its coordinates from which and to which they lead.
struct Direction {
  std::size_t simplex, p, q;
};

BernsteinBasis point_basis(CellKind kind) {
  switch (kind) {
    case CellKind::tet:
      return BernsteinBasis({{4, 2}});
    case CellKind::prism:
      return BernsteinBasis({{3, 2}, {2, 2}});
    case CellKind::hex:
    case CellKind::pyramid:
      break;
  }
  return BernsteinBasis({{2, 2}, {2, 2}, {2, 2}});
}

std::array<Direction, 3> directions(CellKind kind) {
  switch (kind) {
    case CellKind::tet:
      return {{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}};
    case CellKind::prism:
      return {{{0, 0, 1}, {0, 0, 2}, {1, 3, 4}}};
    case CellKind::hex:
    case CellKind::pyramid:
      break;
  }
  return {{{0, 0, 1}, {1, 2, 3}, {2, 4, 5}}};
}

Tangents tangents_of(CellKind kind, const BernsteinBasis& points) {
  const auto [i, j, k] = directions(kind);
  Tangents result{
      {derivative_basis(points, i.simplex), derivative_basis(points, j.simplex), derivative_basis(points, k.simplex)},
      {}};
  // The pyramid is a cube whose upper side shrinks to a point. The tangents along its first two coordinates have the
  // factor (1 - w), which the pyramid's own coordinates do not: (1 - w)^2 Q + 2 w (1 - w) M + w^2 P becomes
  // (1 - w) Q' + 2 w M', with control points Q, M, P of the three layers.
  if (kind == CellKind::pyramid)
    for (int axis = 0; axis < 2; ++axis) {
      Simplices simplices = result.bases[axis].simplices();
      simplices[2].degree = 1;
      result.bases[axis] = BernsteinBasis(std::move(simplices));
    }
  const std::array all{i, j, k};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (kind != CellKind::pyramid || axis == 2) {
      result.differences[axis] = derivative(points, result.bases[axis], all[axis].p, all[axis].q);
      continue;
    }
    for (std::size_t term = 0; term < result.bases[axis].size(); ++term) {
      Exponents from = result.bases[axis].exponents(term);
      const bool is_upper = from[5] == 1;
      ++from[4];  // layer 0 or 1 of the three
      Exponents to = from;
      ++from[all[axis].p], ++to[all[axis].q];
      result.differences[axis].push_back({points.index_of(from), points.index_of(to), is_upper ? 2.0 : 1.0});
    }
  }
  return result;
}

// All that is the same for the cells of one kind.
struct JacobianTables {
  explicit JacobianTables(CellKind kind)
      : points(point_basis(kind)),
        tangents(tangents_of(kind, points)),
        cross_basis(product_basis(tangents.bases[0], tangents.bases[1])),
        basis(product_basis(cross_basis, tangents.bases[2])),
        cross_terms(product_terms(tangents.bases[0], tangents.bases[1], cross_basis)),
        terms(product_terms(cross_basis, tangents.bases[2], basis)) {}

  BernsteinBasis points;
  Tangents tangents;
  BernsteinBasis cross_basis, basis;
  std::vector<ProductTerm> cross_terms, terms;
};

const JacobianTables& tables_of(CellKind kind) {
  static const JacobianTables hex(CellKind::hex), prism(CellKind::prism), pyramid(CellKind::pyramid),
      tet(CellKind::tet);
  switch (kind) {
    case CellKind::hex:
      return hex;
    case CellKind::prism:
      return prism;
    case CellKind::pyramid:
      return pyramid;
    case CellKind::tet:
      break;
  }
  return tet;
}

using Points = std::array<Vec3, most_points>;

// All nodes of the full element, relative to its first corner: those that are missing lie where the element without
// them has these places.
class FullNodes {
 public:
  FullNodes(CellKind kind, std::span<const Vec3> nodes) : places_(node_places_of(static_cast<std::uint8_t>(kind))) {
    const auto corners = static_cast<std::size_t>(corner_count(kind));
    for (const Vec3& node : nodes) nodes_.push_back(node - nodes[0]);
    edges_at_ = corners;
    quads_at_ = corners + places_.edges.size();
    if (nodes_.size() > quads_at_) return;
    for (const LocalQuad& quad : places_.quads) {
      std::array<Vec3, 4> at, middles;
      for (std::size_t i = 0; i < 4; ++i) {
        at[i] = corner(quad[i]);
        middles[i] = edge(quad[i], quad[(i + 1) % 4]);
      }
      nodes_.push_back(middle_of_quad(at, middles));
    }
    if (!places_.has_middle) return;
    const std::span<const Vec3> all(nodes_);
    nodes_.push_back(
        middle_of_hex(all.first(edges_at_), all.subspan(edges_at_, places_.edges.size()), all.subspan(quads_at_)));
  }

  const Vec3& corner(std::size_t i) const { return nodes_[i]; }
  const Vec3& edge(std::size_t a, std::size_t b) const {
    return nodes_[edges_at_ + edge_between(places_.edges, static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b))];
  }
  const Vec3& quad(std::size_t i) const { return nodes_[quads_at_ + i]; }
  const Vec3& middle() const { return nodes_.back(); }

 private:
  NodePlaces places_;
  std::vector<Vec3> nodes_;
  std::size_t edges_at_ = 0, quads_at_ = 0;
};

// The middle control point of a curve through three points.
Vec3 control_point(const Vec3& begin, const Vec3& middle, const Vec3& end) {
  return 2 * middle - 0.5 * (begin + end);
}

// Control points of a grid of nodes on [0, 1]^3, along each axis in turn. The basis lists them with the last coordinate
// fastest.
using Grid = std::array<std::array<std::array<Vec3, 3>, 3>, 3>;
void to_control_points(std::array<std::array<Vec3, 3>, 3>& layer) {
  for (auto& row : layer) row[1] = control_point(row[0], row[1], row[2]);
  for (int j = 0; j < 3; ++j) layer[1][j] = control_point(layer[0][j], layer[1][j], layer[2][j]);
}

Grid hex_grid(const FullNodes& nodes) {
  Grid grid;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        const int middles = (i == 1) + (j == 1) + (k == 1);
        const int low = hex_corner_at[i / 2][j / 2][k / 2], high = hex_corner_at[(i + 1) / 2][(j + 1) / 2][(k + 1) / 2];
        if (middles == 0) grid[i][j][k] = nodes.corner(low);
        if (middles == 1) grid[i][j][k] = nodes.edge(low, high);
        // In the order x-, x+, y-, y+, z-, z+.
        if (middles == 2) grid[i][j][k] = nodes.quad(i != 1 ? i / 2 : j != 1 ? 2 + j / 2 : 4 + k / 2);
        if (middles == 3) grid[i][j][k] = nodes.middle();
      }
  for (auto& layer : grid) to_control_points(layer);
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k) grid[1][j][k] = control_point(grid[0][j][k], grid[1][j][k], grid[2][j][k]);
  return grid;
}

Grid pyramid_grid(const FullNodes& nodes) {
  constexpr std::uint8_t at[2][2] = {{0, 3}, {1, 2}};
  std::array<std::array<Vec3, 3>, 3> base, half;
  const Vec3& apex = nodes.corner(4);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const std::uint8_t low = at[i / 2][j / 2], high = at[(i + 1) / 2][(j + 1) / 2];
      base[i][j] = i == 1 && j == 1 ? nodes.quad(0) : low == high ? nodes.corner(low) : nodes.edge(low, high);
      // Bilinear between the control points of the edges to the apex.
      half[i][j] = {};
      for (const std::uint8_t corner : {low, high, at[i / 2][(j + 1) / 2], at[(i + 1) / 2][j / 2]})
        half[i][j] += 0.25 * control_point(nodes.corner(corner), nodes.edge(corner, 4), apex);
    }
  to_control_points(base);
  Grid grid;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) grid[i][j] = {base[i][j], half[i][j], apex};
  return grid;
}

Points control_points(CellKind kind, std::span<const Vec3> given, const BernsteinBasis& basis) {
  const FullNodes nodes(kind, given);
  Points points;
  if (kind == CellKind::hex || kind == CellKind::pyramid) {
    const Grid grid = kind == CellKind::hex ? hex_grid(nodes) : pyramid_grid(nodes);
    for (std::size_t term = 0; term < basis.size(); ++term) {
      const Exponents& e = basis.exponents(term);
      points[term] = grid[e[1]][e[3]][e[5]];
    }
    return points;
  }
  // A triangle of a prism at one of three heights, or a tet: corners, and edges between two of them.
  const auto at = [&](std::size_t a, std::size_t b, int height) {
    if (kind == CellKind::tet) return a == b ? nodes.corner(a) : nodes.edge(a, b);
    if (height != 1) {
      const std::size_t up = height == 2 ? 3 : 0;
      return a == b ? nodes.corner(a + up) : nodes.edge(a + up, b + up);
    }
    if (a == b) return nodes.edge(a, a + 3);
    return nodes.quad(a + b == 1 ? 0 : a + b == 3 ? 1 : 2);
  };
  const auto in_simplex = [&](std::size_t a, std::size_t b, int height) {
    return a == b ? at(a, b, height) : control_point(at(a, a, height), at(a, b, height), at(b, b, height));
  };
  const std::size_t coordinates = kind == CellKind::tet ? 4 : 3;
  for (std::size_t term = 0; term < basis.size(); ++term) {
    const Exponents& e = basis.exponents(term);
    std::size_t a = 0;
    while (e[a] == 0) ++a;
    std::size_t b = coordinates - 1;
    while (e[b] == 0) --b;
    const int height = kind == CellKind::tet ? 0 : e[4];
    points[term] = height != 1 ? in_simplex(a, b, height)
                               : control_point(in_simplex(a, b, 0), in_simplex(a, b, 1), in_simplex(a, b, 2));
  }
  return points;
}

// The coefficients of the Jacobian, and a bound of what rounding did to each.
struct Coefficients {
  std::array<double, most_coefficients> values{};
  double rounding = 0;
};

Coefficients jacobian(const JacobianTables& tables, const Points& points) {
  std::array<std::array<Vec3, most_tangents>, 3> tangents;
  std::array<double, 3> longest{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < tables.tangents.differences[axis].size(); ++i) {
      const Difference& difference = tables.tangents.differences[axis][i];
      tangents[axis][i] = difference.factor * (points[difference.to] - points[difference.from]);
      longest[axis] = std::max(longest[axis], norm(tangents[axis][i]));
    }
  std::array<Vec3, most_cross_products> products{};
  for (const ProductTerm& term : tables.cross_terms)
    products[term.product] += term.weight * cross(tangents[0][term.a], tangents[1][term.b]);
  Coefficients result;
  for (const ProductTerm& term : tables.terms)
    result.values[term.product] += term.weight * dot(products[term.a], tangents[2][term.b]);
  // Control points are off by a few units of the last place of their size, hence tangents, too, however short they are.
  // Each error counts with the two other tangents. Sums have at most 18 x 4 products, each rounded fewer than 100
  // times; a halving of a line of six coefficients takes five means in turn.
  double size = 0;
  for (std::size_t i = 0; i < tables.points.size(); ++i) size = std::max(size, norm(points[i]));
  const auto [one, two, three] = longest;
  result.rounding = std::numeric_limits<double>::epsilon() *
                    (128 * size * (one * two + two * three + one * three) + 5.0 * most_halvings * one * two * three);
  return result;
}

}  // namespace

double least_at_corners(CellKind kind, std::span<const Vec3> nodes) {
  const JacobianTables& tables = tables_of(kind);
  const Coefficients coefficients = jacobian(tables, control_points(kind, nodes, tables.points));
  double least = std::numeric_limits<double>::infinity();
  for (const std::int32_t corner : tables.basis.corners()) least = std::min(least, coefficients.values[corner]);
  return least;
}

bool is_above(CellKind kind, std::span<const Vec3> nodes, double least) {
  const JacobianTables& tables = tables_of(kind);
  const Coefficients coefficients = jacobian(tables, control_points(kind, nodes, tables.points));
  return is_above(tables.basis, std::span(coefficients.values).first(tables.basis.size()),
                  std::max(least, 0.0) + coefficients.rounding);
}

}  // namespace hexpipe::curved
