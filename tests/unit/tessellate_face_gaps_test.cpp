#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <gp_Ax3.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "tools/tessellate/face_gaps.hpp"

namespace hexpipe::tessellate {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TopoDS_Face plane(double tolerance_of_edges = 1e-7) {
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(gp_Pln(gp_Ax3()), 0, 10, 0, 10).Face();
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
    BRep_Builder().UpdateEdge(TopoDS::Edge(edge.Current()), tolerance_of_edges);
  return face;
}

std::vector<NodeEdge> around(std::int32_t count) {
  std::vector<NodeEdge> border;
  for (std::int32_t i = 0; i < count; ++i) border.emplace_back(i, (i + 1) % count);
  return border;
}

Vec3 area_of(const std::vector<Triangle>& triangles, const std::vector<Vec3>& nodes) {
  Vec3 area{};
  for (const auto& [a, b, c] : triangles) area = area + 0.5 * cross(nodes[b] - nodes[a], nodes[c] - nodes[a]);
  return area;
}

// How often each edge is used in one direction more than in the other.
std::map<NodeEdge, int> border_of(const std::vector<Triangle>& triangles) {
  std::map<NodeEdge, int> count;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      if (--count[{b, a}] == 0) count.erase({b, a});
      if (++count[{a, b}] == 0) count.erase({a, b});
    }
  std::erase_if(count, [](const auto& entry) { return entry.second < 0; });
  return count;
}

TEST(FillGaps, TakesABorderThatGoesTheWrongWay) {
  const std::vector<Vec3> nodes{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 0}};
  std::vector<Triangle> triangles{{0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}};
  const FilledGaps none = fill_gaps(plane(), around(4), triangles, nodes, 0.1);
  EXPECT_TRUE(none.are_closed);
  EXPECT_THAT(none.triangles, IsEmpty());
  triangles.pop_back();
  const FilledGaps one = fill_gaps(plane(), around(4), triangles, nodes, 0.1);
  EXPECT_TRUE(one.are_closed);
  ASSERT_EQ(one.triangles.size(), 1u);
  EXPECT_NEAR(area_of(one.triangles, nodes).z, -4, 1e-12);
}

// A square with a square hole.
TEST(FillGaps, TakesAHoleThatGoesTheWrongWay) {
  std::vector<Vec3> nodes;
  for (const double half : {4.0, 1.0})
    for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
      nodes.push_back({5 + half * x, 5 + half * y, 0});
  std::vector<Triangle> triangles;
  std::vector<NodeEdge> border;
  for (std::int32_t i = 0; i < 4; ++i) {
    const std::int32_t next = (i + 1) % 4;
    triangles.insert(triangles.end(), {Triangle{i, next, i + 4}, Triangle{next, next + 4, i + 4}});
    border.insert(border.end(), {NodeEdge{i, next}, NodeEdge{i + 4, next + 4}});
  }
  EXPECT_TRUE(fill_gaps(plane(), border, triangles, nodes, 0.1).are_closed);
  EXPECT_THAT(fill_gaps(plane(), border, triangles, nodes, 0.1).triangles, IsEmpty());
  const Triangle gone = triangles.front();
  triangles.erase(triangles.begin());
  const FilledGaps one = fill_gaps(plane(), border, triangles, nodes, 0.1);
  EXPECT_TRUE(one.are_closed);
  EXPECT_NEAR(area_of(one.triangles, nodes).z, area_of({gone}, nodes).z, 1e-12);
}

TEST(FillGaps, AddsNothingWhereThereAreNone) {
  const std::vector<Vec3> nodes{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  const FilledGaps filled = fill_gaps(plane(), around(4), triangles, nodes, 0.1);
  EXPECT_TRUE(filled.are_closed);
  EXPECT_THAT(filled.triangles, IsEmpty());
  EXPECT_THAT(filled.joins, IsEmpty());
}

// An L, whose inner corner no triangle may cover.
TEST(FillGaps, MakesTheTrianglesOfAPlaneFaceThatHasNone) {
  const std::vector<Vec3> nodes{{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}};
  const FilledGaps filled = fill_gaps(plane(), around(6), {}, nodes, 0.1);
  ASSERT_TRUE(filled.are_closed);
  EXPECT_EQ(filled.triangles.size(), 4u);
  double area = 0;
  for (const Triangle& t : filled.triangles) area += norm(area_of({t}, nodes));
  EXPECT_DOUBLE_EQ(area, 7);
  EXPECT_DOUBLE_EQ(area_of(filled.triangles, nodes).z, 7);
}

TEST(FillGaps, ClosesAHoleBetweenTriangles) {
  const std::vector<Vec3> nodes{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 0}};
  const std::vector<Triangle> triangles{{0, 1, 4}, {2, 3, 4}, {3, 0, 4}};
  const FilledGaps filled = fill_gaps(plane(), around(4), triangles, nodes, 0.1);
  ASSERT_EQ(filled.triangles.size(), 1u);
  EXPECT_DOUBLE_EQ(area_of(filled.triangles, nodes).z, 4);
}

// Two sides from node 0 on cross each other, by less than their tolerance.
TEST(FillGaps, JoinsTheSidesOfATipAsFarAsTheyAreNear) {
  const std::vector<Vec3> nodes{{0, 0, 0},     {1, 0.004, 0}, {2, 0.1, 0},     {6, 2, 0},
                                {2.1, 0.5, 0}, {1.1, 0, 0},   {0.5, -0.003, 0}};
  const FilledGaps filled = fill_gaps(plane(0.01), around(7), {}, nodes, 0.05);
  ASSERT_TRUE(filled.are_closed);
  EXPECT_THAT(filled.joins, ElementsAre(NodeEdge(6, 0), NodeEdge(5, 1)));
  const std::map<NodeEdge, int> border{{{1, 2}, 1}, {{2, 3}, 1}, {{3, 4}, 1}, {{4, 1}, 1}};
  EXPECT_EQ(border_of(filled.triangles), border);
  EXPECT_THAT(fill_gaps(plane(), around(7), {}, nodes, 0.05).joins, IsEmpty());
}

// A quarter of a cylinder of radius 2, of which only the border is known.
TEST(FillGaps, PutsNodesOnAFaceThatBends) {
  const double angle = std::numbers::pi / 2, deviation = 0.02;
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(gp_Cylinder(gp_Ax3(), 2), 0, angle, 0, 3).Face();
  std::vector<Vec3> nodes;
  const auto arc = [&](double from, double z) {
    for (int i = 0; i < 8; ++i) {
      const double at = from > 0 ? from * (8 - i) / 8 : angle * i / 8;
      nodes.push_back({2 * std::cos(at), 2 * std::sin(at), z});
    }
  };
  arc(0, 0);
  nodes.push_back({0, 2, 0});
  arc(angle, 3);
  nodes.push_back({2, 0, 3});
  const FilledGaps filled = fill_gaps(face, around(static_cast<std::int32_t>(nodes.size())), {}, nodes, deviation);
  ASSERT_TRUE(filled.are_closed);
  for (const Vec3& p : filled.nodes) EXPECT_NEAR(std::hypot(p.x, p.y), 2, 1e-9);
  nodes.insert(nodes.end(), filled.nodes.begin(), filled.nodes.end());
  EXPECT_EQ(border_of(filled.triangles).size(), 18u);
  double area = 0;
  for (const Triangle& t : filled.triangles) {
    area += norm(area_of({t}, nodes));
    const Vec3 middle = (1.0 / 3) * (nodes[t[0]] + nodes[t[1]] + nodes[t[2]]);
    EXPECT_NEAR(std::hypot(middle.x, middle.y), 2, 1.01 * deviation);
    EXPECT_GT(dot(area_of({t}, nodes), {middle.x, middle.y, 0}), 0);
  }
  EXPECT_NEAR(area, 3 * 2 * angle, 0.02 * area);
}

// Both borders of a tube: no disk closes one of them.
TEST(FillGaps, LeavesOpenWhatGoesRoundTheFace) {
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(gp_Cylinder(gp_Ax3(), 2), 0, 2 * std::numbers::pi, 0, 3).Face();
  std::vector<Vec3> nodes;
  std::vector<NodeEdge> border;
  for (std::int32_t i = 0; i < 16; ++i) {
    const double at = i * std::numbers::pi / 8;
    nodes.push_back({2 * std::cos(at), 2 * std::sin(at), 0});
    nodes.push_back({2 * std::cos(at), 2 * std::sin(at), 3});
    border.emplace_back(2 * i, 2 * ((i + 1) % 16));
    border.emplace_back(2 * ((i + 1) % 16) + 1, 2 * i + 1);
  }
  EXPECT_FALSE(fill_gaps(face, border, {}, nodes, 0.1).are_closed);
}

// A seam has its nodes twice. Between circles with different numbers of nodes edges lean, and the middle of one is
// beside that of its parameters, but not off the cone.
TEST(FillGaps, GoesRoundTheFaceFromASeamToItself) {
  const double slope = std::numbers::pi / 4;
  const TopoDS_Face face =
      BRepBuilderAPI_MakeFace(gp_Cone(gp_Ax3(), slope, 1.5), 0, 2 * std::numbers::pi, 0, 0.5 / std::cos(slope)).Face();
  std::vector<Vec3> nodes;
  const auto add_circle = [&](int count, double radius, double height) {
    for (int i = 0; i <= count; ++i) {
      const double at = (height > 0 ? count - i : i) * 2 * std::numbers::pi / count;
      nodes.push_back({radius * std::cos(at), radius * std::sin(at), height});
    }
  };
  add_circle(54, 1.5, 0);
  add_circle(61, 2, 0.5);
  const FilledGaps filled = fill_gaps(face, around(static_cast<std::int32_t>(nodes.size())), {}, nodes, 0.005);
  EXPECT_TRUE(filled.are_closed);
  EXPECT_THAT(filled.joins, IsEmpty());
  EXPECT_THAT(filled.nodes, IsEmpty());
  EXPECT_EQ(filled.triangles.size(), 54 + 61);
  double area = 0;
  for (const auto& [a, b, c] : filled.triangles) area += 0.5 * norm(cross(nodes[b] - nodes[a], nodes[c] - nodes[a]));
  EXPECT_NEAR(area, std::numbers::pi * (1.5 + 2) * 0.5 / std::cos(slope), 0.01 * area);
}

}  // namespace
}  // namespace hexpipe::tessellate
