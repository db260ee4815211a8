#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "assemble_lattice.hpp"
#include "common/mesh/adjacency.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "tests/unit/random_cases.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/conform/conform.hpp"
#include "tools/assemble/hybrid/extract.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe {
using namespace assemble;
using namespace assemble::shape;
namespace {

// A flat, jittered lattice of which a part is hexes, made conforming and smoothed until nothing moves.
struct SmoothScene {
  testing::Lattice lattice;
  InputSurface surface;
  hybrid::Extract extracted;

  static testing::Lattice lattice_of(Random& random) {
    auto lattice = testing::make_lattice(3);
    testing::jitter(lattice, 0.25, random);
    for (Vec3& p : lattice.mesh.points) p.z *= 0.3;
    testing::tag_boundary(lattice.mesh);
    return lattice;
  }
  explicit SmoothScene(Random random)
      : lattice(lattice_of(random)), surface(lattice.mesh, TetAdjacency(lattice.mesh, "test")) {
    const hybrid::SurfaceTags tags(lattice.mesh);
    const auto chosen = testing::candidates_in(testing::random_choice(lattice, 0.6, random));
    auto mesh = choice::Selection(lattice.mesh, tags, lattice.cubes, chosen, {}).take_mesh();
    conform::make_conforming(mesh, tags, lattice.cubes, 1e-4);
    extracted = hybrid::extract(mesh, tags);
    const SlidingSurface sliding = this->sliding();
    smooth(extracted.mesh, 20, &sliding);
  }
  SlidingSurface sliding() const { return {surface, lattice.mesh.points, extracted.origin}; }
};

struct Qualities {
  std::vector<double> hexes, prisms, others;
  double worst_pyramid = 1, worst_tet = 1, volume = 0;
  bool valid = true;

  explicit Qualities(const MixedMesh& mesh) {
    const auto each = [&](CellKind kind, const auto& block, std::vector<double>& list) {
      double worst = 1;
      for (const auto& cell : block.cells) {
        const auto at = corner_points(mesh.points, cell);
        const auto corners = std::span<const Vec3>(at).first(cell.size());
        valid = valid && is_valid(kind, corners);
        volume += cell_volume(kind, corners);
        list.push_back((kind == CellKind::tet ? std::sqrt(2.0) : 1) * least_corner_scaled_jacobian(kind, corners));
        worst = std::min(worst, list.back());
      }
      return worst;
    };
    each(CellKind::hex, mesh.hexes, hexes);
    each(CellKind::prism, mesh.prisms, prisms);
    worst_pyramid = each(CellKind::pyramid, mesh.pyramids, others);
    worst_tet = each(CellKind::tet, mesh.tets, others);
  }
};

TEST(RaiseWorst, TheWorstCellRisesAndTheOthersStayGoodEnough) {
  std::int64_t raised_in_all = 0;
  const std::int64_t seeds = testing::random_cases(100);
  for (std::int64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    SmoothScene scene{Random(static_cast<std::uint64_t>(seed))};
    MixedMesh& mesh = scene.extracted.mesh;
    const Qualities before(mesh);
    const std::vector<Vec3> places = mesh.points;
    const std::int64_t raised = raise_worst_cells(mesh, scene.sliding());
    raised_in_all += raised;
    EXPECT_EQ(raised == 0, mesh.points == places);
    const Qualities after(mesh);
    EXPECT_EQ(after.valid, before.valid);
    EXPECT_NEAR(after.volume, before.volume, 1e-10);
    EXPECT_GE(after.worst_pyramid, std::min(before.worst_pyramid, good_enough) - 1e-9);
    EXPECT_GE(after.worst_tet, std::min(before.worst_tet, good_enough) - 1e-9);
    EXPECT_TRUE(raised == 0 || after.worst_pyramid > before.worst_pyramid || after.worst_tet > before.worst_tet);
    double sum = 0;
    for (std::size_t c = 0; c < before.others.size(); ++c) {
      EXPECT_GE(after.others[c], std::min(before.others[c], good_enough) - 1e-9) << c;
      sum += after.others[c] - before.others[c];
    }
    EXPECT_GE(sum, -1e-9);
    for (std::size_t c = 0; c < before.hexes.size(); ++c)
      EXPECT_GE(after.hexes[c], std::min(before.hexes[c], least_hex_quality) - 1e-9) << c;
  }
  EXPECT_GT(raised_in_all, 0);
}

}  // namespace
}  // namespace hexpipe
