#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepPrimAPI_MakeWedge.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <Geom_SphericalSurface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>
#include <gp_Ax3.hxx>
#include <gp_Sphere.hxx>
#include <gp_Trsf.hxx>
#include <initializer_list>
#include <numbers>

#include "tools/tessellate/triangulate.hpp"

namespace hexpipe::tessellate {
namespace {

CadModel model_of(std::initializer_list<TopoDS_Shape> shapes) {
  BRep_Builder builder;
  TopoDS_Compound whole;
  builder.MakeCompound(whole);
  for (const TopoDS_Shape& shape : shapes) builder.Add(whole, shape);
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

double volume_of(const formats::SurfaceSoup& surface) {
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles)
    volume += det(surface.points[a], surface.points[b], surface.points[c]) / 6;
  return volume;
}

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return std::abs(properties.Mass());
}

// Also turned inside out and in a mirror. The border of OpenCASCADE's torus goes around it the wrong way.
TEST(Triangulate, ClosesThePrimitivesOfOpenCascade) {
  const double turn = 2 * std::numbers::pi;
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(3, 0, 0), gp_Dir(1, 2, 3)));
  int number = 0;
  for (const TopoDS_Shape& shape :
       {BRepPrimAPI_MakeSphere(1).Solid(), BRepPrimAPI_MakeSphere(1, -0.5, 1, 2).Solid(),
        BRepPrimAPI_MakeCylinder(1, 3).Solid(), BRepPrimAPI_MakeCylinder(1, 3, 2).Solid(),
        BRepPrimAPI_MakeCone(1, 0, 2).Solid(), BRepPrimAPI_MakeCone(0.5, 1, 2, 4).Solid(),
        BRepPrimAPI_MakeTorus(3, 1).Solid(), BRepPrimAPI_MakeTorus(3, 1, 2).Solid(),
        BRepPrimAPI_MakeTorus(3, 1, 1, turn - 1).Solid(), BRepPrimAPI_MakeTorus(3, 1, 0.5, 2, 3).Solid(),
        BRepPrimAPI_MakeWedge(1, 2, 3, 0.5).Solid()}) {
    ++number;
    const TopoDS_Shape mirrored = BRepBuilderAPI_Transform(shape, mirror).Shape();
    for (const TopoDS_Shape& turned : {shape, shape.Reversed(), mirrored, mirrored.Reversed()}) {
      SCOPED_TRACE(number);
      const Triangulation made = triangulate(model_of({turned}), {.deviation = 0.01}, "primitive");
      EXPECT_EQ(made.gap_triangles, 0U);
      EXPECT_NEAR(volume_of(made.surface), volume_of(shape), 0.02 * volume_of(shape));
    }
  }
}

// IGES files of single surfaces, as Rhinoceros writes a sphere.
TEST(MakeBodies, TakesAClosedFaceWithoutAShell) {
  const gp_Sphere of(gp_Ax3(), 1);
  const TopoDS_Shape face = BRepBuilderAPI_MakeFace(new Geom_SphericalSurface(of), 1e-7).Face();
  CadModel model;
  make_bodies(face, "sphere.igs", model);
  ASSERT_EQ(model.bodies.size(), 1U);
  EXPECT_NEAR(volume_of(triangulate(model, {}, "sphere.igs").surface), volume_of(model.bodies.front().solid), 0.1);
}

// As Gmsh writes them.
TEST(FindSheets, LeavesOutTheFacesOfBodies) {
  const TopoDS_Shape body = BRepPrimAPI_MakeCylinder(1, 3).Solid(), loose = sphere(0);
  BRep_Builder builder;
  TopoDS_Compound whole;
  builder.MakeCompound(whole);
  builder.Add(whole, body);
  for (TopExp_Explorer face(body, TopAbs_FACE); face.More(); face.Next()) builder.Add(whole, face.Current().Reversed());
  for (int i = 0; i < 2; ++i) builder.Add(whole, loose);
  CadModel model;
  find_sheets(whole, model);
  ASSERT_EQ(model.sheets.size(), 1U);
  EXPECT_TRUE(model.sheets.front().IsSame(loose));
}

}  // namespace
}  // namespace hexpipe::tessellate
