#include "tools/tetmesh/surface/step_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe {
using namespace tetmesh::geometry;
using namespace tetmesh::surface;
namespace {

using testing::box;
using testing::Facets;
using testing::surface_of;

// A surface with its feature curves, of which each wants its length.
struct Curves {
  FeatureMesh mesh;
  std::vector<FeatureCurve> curves;
  FieldSurface surface;
  CrossField field;
  SurfaceLinks links;
  CurveOfHalfEdge curve_of;
  std::vector<CurveDemand> demands;

  explicit Curves(const Facets& facets)
      : mesh(refined(facets)),
        curves(feature_curves(mesh)),
        surface(mesh, 1),
        field(cross_field(surface)),
        links(surface, field),
        curve_of(links.of.size(), -1) {
    for (std::size_t i = 0; i < curves.size(); ++i) {
      double length = 0;
      for (std::size_t k = 0; k + 1 < curves[i].vertices.size(); ++k) {
        const HalfEdge h = half_edge_of(mesh, mesh.find_halfedge(curves[i].vertices[k], curves[i].vertices[k + 1]));
        curve_of[h] = curve_of[surface.twins[h]] = static_cast<std::int32_t>(i);
        length += norm(surface.edge_vector(h));
      }
      demands.push_back({length, length, length, curves[i].closed});
    }
  }

  Vec3 along(std::size_t curve) const {
    return mesh.position(curves[curve].vertices.back()) - mesh.position(curves[curve].vertices.front());
  }
  std::vector<int> plan() const { return plan_steps(links, demands, curve_of); }

 private:
  static FeatureMesh refined(const Facets& facets) {
    FeatureMesh mesh(surface_of(facets), 40);
    refine_surface(mesh, 1, 1e-6);
    return mesh;
  }
};

// By the axis along which they are.
std::map<int, std::vector<std::size_t>> edges_by_axis(const Curves& box) {
  std::map<int, std::vector<std::size_t>> edges;
  for (std::size_t i = 0; i < box.curves.size(); ++i) {
    const Vec3 along = box.along(i);
    edges[std::abs(along.x) > 1 ? 0 : std::abs(along.y) > 1 ? 1 : 2].push_back(i);
  }
  return edges;
}

TEST(StepPlan, IsTheSameForAllEdgesAlongAnAxisOfABox) {
  Curves box(testing::box({0, 0, 0}, {6, 7, 8}));
  const auto edges = edges_by_axis(box);
  for (const auto& [axis, four] : edges) ASSERT_EQ(four.size(), 4u);
  box.demands[edges.at(0)[0]].steps = 6.6;  // alone it would have seven
  box.demands[edges.at(1)[2]].steps = 7.4;
  const std::vector<int> planned = box.plan();
  for (const auto& [axis, four] : edges)
    for (const std::size_t edge : four) EXPECT_EQ(planned[edge], 6 + axis);
}

TEST(StepPlan, LeavesOutFacesThatWouldPressAnEdgeTooMuch) {
  Curves box(testing::box({0, 0, 0}, {6, 7, 8}));
  const auto edges = edges_by_axis(box);
  box.demands[edges.at(0)[0]].steps = box.demands[edges.at(0)[0]].sizes = 12;
  const std::vector<int> planned = box.plan();
  EXPECT_EQ(planned[edges.at(0)[0]], 12);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(planned[edges.at(0)[i]], 6);
}

// A prism; in each of its triangles the field has a singularity, so that only the sum there is even.
TEST(StepPlan, IsEvenAroundFacesWithASingularity) {
  const double height = std::sqrt(27.0);
  const Vec3 a{0, 0, 0}, b{6, 0, 0}, c{3, height, 0}, up{0, 0, 5};
  const Facets facets{{a, c, b},      {a + up, b + up, c + up}, {a, b, b + up}, {a, b + up, a + up},
                      {b, c, c + up}, {b, c + up, b + up},      {c, a, a + up}, {c, a + up, c + up}};
  Curves prism(facets);
  ASSERT_EQ(prism.curves.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i)
    if (std::abs(prism.along(i).z) < 1 && std::abs(prism.along(i).y) < 1) prism.demands[i].steps = 6.9;
  const std::vector<int> planned = prism.plan();
  int sum = 0;
  for (std::size_t i = 0; i < 9; ++i)
    if (std::abs(prism.along(i).z) > 1)
      EXPECT_EQ(planned[i], 5);
    else
      sum += planned[i];
  EXPECT_EQ(sum / 2 % 2, 0) << "7 + 6 + 6 would be odd";
  EXPECT_EQ(sum % 2, 0);
}

}  // namespace
}  // namespace hexpipe
