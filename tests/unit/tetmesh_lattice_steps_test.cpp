// What the lattices of surfaces and volumes share: steps by least squares, and proposals that agree.

#include "tools/tetmesh/fields/lattice_steps.hpp"

#include <gtest/gtest.h>

#include "tools/tetmesh/fields/lattice_proposals.hpp"

namespace hexpipe::tetmesh::fields {
namespace {

// Neighbours on both axes, as a lattice sees them whose coordinates have these gradients (in columns).
StepFit<2> fit_of(const Eigen::Matrix2d& gradients) {
  StepFit<2> fit;
  for (const Eigen::Vector2d& way : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0.3, 1), Eigen::Vector2d(-1, 0.5)}) {
    const Eigen::Vector2d distance = gradients.transpose() * way;
    fit.add(2, way, {distance[0], distance[1]});
  }
  return fit;
}

TEST(StepFit, AreTheInverseOfTheGradients) {
  Eigen::Matrix2d gradients;
  gradients << 2, 0, 0.5, 1;
  const auto steps = fit_of(gradients).steps(false);
  ASSERT_TRUE(steps);
  EXPECT_TRUE((gradients.transpose() * *steps).isIdentity(1e-12)) << *steps;
}

TEST(StepFit, KeepToTheFieldAsStronglyAsItHolds) {
  StepFit<2> fit = fit_of(2 * Eigen::Matrix2d::Identity());
  fit.hold(1e6 * fit.moment(), Eigen::Matrix2d::Identity());
  const auto steps = fit.steps(false);
  ASSERT_TRUE(steps);
  EXPECT_TRUE(steps->isIdentity(1e-5)) << *steps;
}

TEST(StepFit, AreNotKnownWhereTheLatticeFoldsOrIsMirrored) {
  const Eigen::Matrix2d mirrored = Eigen::Vector2d(1, -1).asDiagonal(), folded = Eigen::Vector2d(1, 0.1).asDiagonal();
  EXPECT_FALSE(fit_of(folded).steps(true));
  EXPECT_FALSE(fit_of(mirrored).steps(false));
  EXPECT_TRUE(fit_of(mirrored).steps(true));
}

TEST(LatticeProposals, ANodeSeesThePointsAroundIt) {
  std::vector<std::array<double, 2>> seen;
  for_each_point_around(std::array{0.25, -0.4}, 0.7, [&](const std::array<double, 2>& cells, double distance) {
    EXPECT_EQ(distance, std::max(std::abs(cells[0]), std::abs(cells[1])));
    seen.push_back(cells);
  });
  // Along the first axis the points are 0.25 behind and 0.75 ahead, along the second 0.6 behind and 0.4 ahead.
  EXPECT_EQ(seen, (std::vector<std::array<double, 2>>{{-0.25, -0.6}, {-0.25, 0.4}}));
}

struct Proposed {
  Vec3 at;
  double trust;

  const Vec3& place() const { return at; }
};

TEST(LatticeProposals, ThoseOfOnePointAgreeAndTheMostTrustedComeFirst) {
  std::vector<Proposed> proposals{{{5, 0, 0}, 2}, {{0, 0, 0}, 1}, {{0.2, 0, 0}, 3}};
  agree(
      Vec3(), [](const Proposed&) { return 1.0; },
      [](const ProposalIndex<Proposed>& index, const Proposed& p) {
        TrustedSum sum;
        index.for_each_at(p.at, 1, 0, [&](const Proposed& other) { sum.add(other.trust, other.at); });
        return Proposed{sum.sum * (1 / sum.trust), sum.trust};
      },
      proposals);
  ASSERT_EQ(proposals.size(), 3);
  EXPECT_DOUBLE_EQ(proposals[0].at.x, 0.15);
  EXPECT_DOUBLE_EQ(proposals[1].at.x, 0.15);
  EXPECT_EQ(proposals[2].at.x, 5);
  EXPECT_EQ(proposals[0].trust, 4);
}

}  // namespace
}  // namespace hexpipe::tetmesh::fields
