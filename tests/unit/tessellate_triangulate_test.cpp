#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>
#include <gp_Ax3.hxx>
#include <gp_Sphere.hxx>
#include <initializer_list>
#include <numbers>

#include "tools/tessellate/triangulate.hpp"

namespace hexpipe::tessellate {
namespace {

CadModel model_of(std::initializer_list<TopoDS_Shape> faces) {
  BRep_Builder builder;
  TopoDS_Compound whole;
  builder.MakeCompound(whole);
  for (const TopoDS_Shape& face : faces) builder.Add(whole, face);
  CadModel model;
  model.bodies.push_back({whole, "body"});
  return model;
}

TopoDS_Shape sphere(double from) {
  return BRepBuilderAPI_MakeFace(gp_Sphere(gp_Ax3(), 1), 0, 2 * std::numbers::pi, from, std::numbers::pi / 2).Face();
}

TEST(DefaultSize, IsThatOfTetmesh) {
  // At least 6,000 cubes fill the sphere.
  EXPECT_NEAR(default_size_of(model_of({sphere(-std::numbers::pi / 2)})), std::cbrt(4 * std::numbers::pi / 3 / 6000),
              1e-4);
}

TEST(DefaultSize, DoesNotVanishWithTheVolume) {
  // Half a sphere there and back.
  const TopoDS_Shape half = sphere(0);
  const CadModel model = model_of({half, half.Reversed()});
  EXPECT_NEAR(default_size_of(model), 0.05 * 3, 0.01);
  TriangulationOptions options;
  options.open = true;
  EXPECT_LT(triangulate(model, options, "half.step").surface.triangles.size(), 20000U);
}

}  // namespace
}  // namespace hexpipe::tessellate
