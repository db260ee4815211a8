#include "common/curved/curved_validity.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "cell_shapes.hpp"
#include "common/curved/bend.hpp"
#include "common/curved/nodes.hpp"
#include "common/mesh/mixed_mesh.hpp"
#include "tests/unit/random_cases.hpp"

namespace hexpipe {
namespace {

constexpr std::array kinds{CellKind::hex, CellKind::prism, CellKind::pyramid, CellKind::tet};

std::vector<Vec3> unit_corners(CellKind kind) {
  std::vector<Vec3> corners = unit_cell(kind);
  if (kind == CellKind::pyramid) corners[4].z = 0.7;  // edges of length 1, nearly
  return corners;
}

// Where the nodes of the unit cell lie: corners, and the middles of what node_places_of() lists.
std::vector<Vec3> unit_nodes(CellKind kind, bool full) {
  std::vector<Vec3> nodes = unit_corners(kind);
  const std::vector<Vec3> corners = nodes;
  const NodePlaces places = node_places_of(static_cast<std::uint8_t>(kind));
  for (const auto& [a, b] : places.edges) nodes.push_back(0.5 * (corners[a] + corners[b]));
  if (!full) return nodes;
  for (const LocalQuad& q : places.quads)
    nodes.push_back(0.25 * (corners[q[0]] + corners[q[1]] + corners[q[2]] + corners[q[3]]));
  if (places.has_middle) nodes.push_back({0.5, 0.5, 0.5});
  return nodes;
}

// The monomials that span the element, at a point of the unit cell, with their gradients: another description of the
// elements than the one in curved_validity.cpp. M. Bergot, G. Cohen, M. Duruflé (2010) for the pyramid, whose apex is
// over the middle of [-1, 1]^2 here.
struct Monomial {
  double value;
  Vec3 gradient;
};
Monomial power(const Vec3& p, int i, int j, int k) {
  const auto to = [](double x, int n) { return n < 0 ? 0 : std::pow(x, n); };
  return {to(p.x, i) * to(p.y, j) * to(p.z, k),
          {i * to(p.x, i - 1) * to(p.y, j) * to(p.z, k), j * to(p.x, i) * to(p.y, j - 1) * to(p.z, k),
           k * to(p.x, i) * to(p.y, j) * to(p.z, k - 1)}};
}
// x^i y^j / (1 - z)^n
Monomial rational(const Vec3& p, int i, int j, int n) {
  const Monomial above = power(p, i, j, 0);
  const double w = 1 - p.z, below = std::pow(w, -n);
  return {above.value * below, {above.gradient.x * below, above.gradient.y * below, n * above.value * below / w}};
}

std::vector<Monomial> monomials(CellKind kind, bool full, const Vec3& p) {
  std::vector<Monomial> list;
  for (int i = 0; i <= 2; ++i)
    for (int j = 0; j <= 2; ++j)
      for (int k = 0; k <= 2; ++k) {
        const bool in_hex = full || (i == 2) + (j == 2) + (k == 2) <= 1;
        const bool in_prism = i + j <= 2 && (full || !(i + j == 2 && k == 2));
        const bool in_tet = i + j + k <= 2;
        if (kind == CellKind::hex ? in_hex : kind == CellKind::prism ? in_prism : in_tet)
          list.push_back(power(p, i, j, k));
      }
  if (kind == CellKind::pyramid) {
    list.push_back(rational(p, 1, 1, 1));
    list.push_back(rational(p, 2, 1, 1));
    list.push_back(rational(p, 1, 2, 1));
    if (full) list.push_back(rational(p, 2, 2, 2));
  }
  return list;
}

// A place of the unit cell as the monomials have it: the pyramid's is the symmetric one.
Vec3 reference(CellKind kind, const Vec3& p) {
  return kind == CellKind::pyramid ? Vec3{2 * p.x - 1, 2 * p.y - 1, p.z / 0.7} : p;
}

// Solves a x = b in place.
void solve(std::vector<std::vector<double>>& a, std::vector<Vec3>& b) {
  const std::size_t n = a.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    for (std::size_t i = k; i < n; ++i)
      if (std::abs(a[i][k]) > std::abs(a[best][k])) best = i;
    std::swap(a[k], a[best]), std::swap(b[k], b[best]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) b[k] *= 1 / a[k][k];
}

// The least Jacobian over a grid of places.
class SampledCell {
 public:
  SampledCell(CellKind kind, bool full) : kind_(kind), full_(full) {
    constexpr int steps = 8;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps; ++j)
        for (int k = 0; k <= steps; ++k) {
          Vec3 p{1.0 * i / steps, 1.0 * j / steps, 1.0 * k / steps};
          if (kind == CellKind::prism && p.x + p.y > 1) continue;
          if (kind == CellKind::tet && p.x + p.y + p.z > 1) continue;
          if (kind == CellKind::pyramid) {
            const double w = std::min(p.z, 0.999);  // the Jacobian at the apex depends on the way there
            p = {(2 * p.x - 1) * (1 - w), (2 * p.y - 1) * (1 - w), w};
          }
          samples_.push_back(monomials(kind, full, p));
        }
  }

  double least(const std::vector<Vec3>& nodes) const {
    std::vector<std::vector<double>> rows;
    std::vector<Vec3> factors = nodes;
    for (const Vec3& node : unit_nodes(kind_, full_)) {
      // The apex itself is where rational monomials vanish.
      Vec3 p = reference(kind_, node);
      if (kind_ == CellKind::pyramid && p.z == 1) p = {0, 0, 1 - 1e-9};
      rows.emplace_back();
      for (const Monomial& m : monomials(kind_, full_, p)) rows.back().push_back(m.value);
    }
    solve(rows, factors);
    double result = std::numeric_limits<double>::infinity();
    for (const auto& sample : samples_) {
      Vec3 x, y, z;
      for (std::size_t i = 0; i < sample.size(); ++i) {
        x += sample[i].gradient.x * factors[i];
        y += sample[i].gradient.y * factors[i];
        z += sample[i].gradient.z * factors[i];
      }
      result = std::min(result, det(x, y, z));
    }
    return result;
  }

 private:
  CellKind kind_;
  bool full_;
  std::vector<std::vector<Monomial>> samples_;
};

class CurvedValidity : public ::testing::TestWithParam<std::tuple<CellKind, bool>> {};

// What is shown to be valid is positive wherever one looks; and what is positive by a margin is shown to be valid.
TEST_P(CurvedValidity, AgreesWithSamplingOnThousandsOfCells) {
  const auto [kind, full] = GetParam();
  const SampledCell sampled(kind, full);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> amount(-1, 1);
  int valid = 0, invalid = 0, missed = 0;
  for (int cell = 0; cell < hexpipe::testing::random_cases(1500); ++cell) {
    std::vector<Vec3> nodes = unit_nodes(kind, full);
    const double most = 0.03 + 0.27 * (cell % 100) / 100;
    for (Vec3& node : nodes) node += most * Vec3{amount(random), amount(random), amount(random)};
    const double least = sampled.least(nodes);
    const bool is_valid = curved::is_valid(kind, nodes);
    ASSERT_FALSE(is_valid && least <= 0) << cell;
    (is_valid ? valid : invalid) += 1;
    missed += least > 0.03 && !is_valid ? 1 : 0;
  }
  EXPECT_GT(valid, hexpipe::testing::random_cases(150));
  EXPECT_GT(invalid, hexpipe::testing::random_cases(150));
  EXPECT_LE(missed, hexpipe::testing::random_cases(15));  // between the samples, or undecided
}

INSTANTIATE_TEST_SUITE_P(Kinds, CurvedValidity, ::testing::Combine(::testing::ValuesIn(kinds), ::testing::Bool()),
                         [](const auto& tried) {
                           return fmt::format("Kind{}{}", static_cast<int>(std::get<CellKind>(tried.param)),
                                              std::get<bool>(tried.param) ? "Full" : "Serendipity");
                         });

TEST(CurvedValidityOfStraightCells, IsThatOfTheirCorners) {
  for (const CellKind kind : kinds)
    for (const bool full : {false, true}) {
      std::vector<Vec3> nodes = unit_nodes(kind, full);
      EXPECT_TRUE(curved::is_valid(kind, nodes));
      EXPECT_TRUE(curved::is_above(kind, nodes, 0.999 * curved::least_at_corners(kind, nodes)));
      EXPECT_FALSE(curved::is_above(kind, nodes, 1.001 * curved::least_at_corners(kind, nodes)));
      for (Vec3& node : nodes) node.x = -node.x;
      EXPECT_FALSE(curved::is_valid(kind, nodes));
      for (Vec3& node : nodes) node.x = 0;
      EXPECT_FALSE(curved::is_valid(kind, nodes));
    }
}

TEST(CurvedValidityOfStraightCells, IsNotLostFarFromTheOrigin) {
  for (const CellKind kind : kinds) {
    std::vector<Vec3> nodes = unit_nodes(kind, false);
    for (Vec3& node : nodes) node += Vec3{1e6, -1e6, 1e6};
    EXPECT_TRUE(curved::is_valid(kind, nodes));
  }
}

TEST(MiddleOfQuad, IsTheSameToTheBitFromBothSidesAndAllCorners) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> amount(-1, 1);
  for (int round = 0; round < 50; ++round) {
    std::array<Vec3, 4> corners, edges;
    for (auto* list : {&corners, &edges})
      for (Vec3& at : *list) at = {amount(random), amount(random), amount(random)};
    const Vec3 middle = curved::middle_of_quad(corners, edges);
    for (std::size_t first = 0; first < 4; ++first)
      for (const std::size_t step : {1, 3}) {
        std::array<Vec3, 4> other, between;
        for (std::size_t i = 0; i < 4; ++i) {
          const std::size_t from = (first + i * step) % 4, to = (from + step) % 4;
          other[i] = corners[from];
          between[i] = edges[step == 1 ? from : to];
        }
        EXPECT_EQ(curved::middle_of_quad(other, between), middle);
      }
  }
}

// Coordinates have errors of the size of such a height.
TEST(CurvedValidityOfStraightCells, IsNotShownForHeightsThatRoundingMakes) {
  for (const CellKind kind : kinds)
    for (const double height : {1e-10, 1e-15}) {
      std::vector<Vec3> nodes = unit_nodes(kind, false);
      for (Vec3& node : nodes) node.z *= height;
      EXPECT_EQ(curved::is_valid(kind, nodes), height == 1e-10);
    }
}

// A wall of a quarter of a cylinder, in one hex: radius 1 inside, `outer` outside.
MixedMesh quarter_cylinder(double outer) {
  MixedMesh mesh;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::pair{1.0, 0.0}, {outer, 0.0}, {0.0, outer}, {0.0, 1.0}})
      mesh.points.push_back({x, y, z});
  mesh.hexes.cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
  mesh.hexes.tags = {1};
  for (const LocalQuad& q : HexTopology::quads)
    mesh.quads.cells.push_back({q[0], q[1], q[2], q[3]}), mesh.quads.tags.push_back(1);
  return mesh;
}

// The nodes of edges between 90 degrees go onto their circle.
std::vector<curved::Target> targets_on_circles(const MixedMesh& mesh) {
  std::vector<curved::Target> targets;
  const auto nodes = mesh.second_order->of(12, 0);
  const auto& corners = mesh.hexes.cells[0];
  for (std::size_t e = 0; e < HexTopology::edges.size(); ++e) {
    const Vec3 &a = mesh.points[corners[HexTopology::edges[e][0]]], &b = mesh.points[corners[HexTopology::edges[e][1]]];
    if (a.z != b.z || std::abs(std::hypot(a.x, a.y) - std::hypot(b.x, b.y)) > 1e-12) continue;
    const double radius = std::hypot(a.x, a.y) / std::sqrt(2.0);
    targets.push_back({nodes[e], {radius, radius, a.z}});
  }
  return targets;
}

TEST(Bend, PutsAQuarterOfACylinderOntoItsCircles) {
  for (const bool full : {false, true}) {
    MixedMesh mesh = quarter_cylinder(2);
    curved::add_straight_nodes(mesh, full);
    EXPECT_EQ(mesh.points.size(), full ? 27u : 20u);
    const auto targets = targets_on_circles(mesh);
    ASSERT_EQ(targets.size(), 4u);
    const curved::BendCounts counts = curved::bend(mesh, targets);
    EXPECT_TRUE(counts.drawn_back.empty());
    for (const curved::Target& target : targets) EXPECT_LT(norm(mesh.points[target.node] - target.at), 1e-12);
    std::vector<Vec3> nodes;
    for (const Vertex v : mesh.hexes.cells[0]) nodes.push_back(mesh.points[v]);
    for (const Vertex v : mesh.second_order->of(12, 0)) nodes.push_back(mesh.points[v]);
    EXPECT_TRUE(curved::is_valid(CellKind::hex, nodes));
    // Straight chords would leave these in.
    EXPECT_LT(norm(mesh.points[mesh.second_order->of(12, 0)[1]]) - 2, 1e-12);
  }
}

// The node of the inner side has its place between its edges' nodes, and goes back with them.
TEST(Bend, CountsNodesOfQuadsThatGoBackWithTheirEdges) {
  MixedMesh mesh = quarter_cylinder(1.2);
  curved::add_straight_nodes(mesh, true);
  std::vector<curved::Target> targets = targets_on_circles(mesh);
  std::erase_if(targets, [](const curved::Target& t) { return std::hypot(t.at.x, t.at.y) > 1.1; });
  ASSERT_EQ(targets.size(), 2u);
  const auto& quads = mesh.quads.cells;
  const auto inner = std::ranges::find_if(quads, [](Quad quad) {
    std::ranges::sort(quad);
    return quad == Quad{0, 3, 4, 7};
  });
  ASSERT_NE(inner, quads.end());
  const Vertex node = mesh.second_order->of(9, static_cast<std::size_t>(inner - quads.begin()))[4];
  targets.push_back({node, {targets[0].at.x, targets[0].at.y, 0.5}});
  const curved::BendCounts counts = curved::bend(mesh, targets);
  EXPECT_EQ(counts.drawn_back.size(), 3u);
  EXPECT_TRUE(std::ranges::count(counts.drawn_back, node) == 1);
  EXPECT_EQ(counts.straight, 0);
}

// The inner circle bends through the outer chord, which is held where it is.
TEST(Bend, DrawsNodesBackAsLittleAsIsEnough) {
  MixedMesh mesh = quarter_cylinder(1.2);
  curved::add_straight_nodes(mesh, false);
  std::vector<curved::Target> targets = targets_on_circles(mesh);
  std::erase_if(targets, [](const curved::Target& t) { return std::hypot(t.at.x, t.at.y) > 1.1; });
  ASSERT_EQ(targets.size(), 2u);
  const curved::BendCounts counts = curved::bend(mesh, targets);
  EXPECT_EQ(counts.invalid, 1);
  EXPECT_EQ(counts.drawn_back.size(), 2u);
  EXPECT_EQ(counts.straight, 0);
  EXPECT_GT(counts.farthest, 0);
  std::vector<Vec3> nodes;
  for (const Vertex v : mesh.hexes.cells[0]) nodes.push_back(mesh.points[v]);
  for (const Vertex v : mesh.second_order->of(12, 0)) nodes.push_back(mesh.points[v]);
  EXPECT_TRUE(curved::is_valid(CellKind::hex, nodes));
  // A little further out, and it would not be.
  for (const curved::Target& target : targets) {
    const Vec3 chord{0.5, 0.5, target.at.z};
    nodes[8 + static_cast<std::size_t>(std::ranges::find(mesh.second_order->of(12, 0), target.node) -
                                       mesh.second_order->of(12, 0).begin())] +=
        0.35 * (mesh.points[target.node] - chord);
  }
  EXPECT_FALSE(curved::is_above(CellKind::hex, nodes, 0));
}

}  // namespace
}  // namespace hexpipe
