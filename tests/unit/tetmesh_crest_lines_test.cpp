#include "tools/tetmesh/surface/crest_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "tetmesh_surfaces.hpp"

namespace hexpipe {
using namespace tetmesh::solid;
using namespace tetmesh::surface;
namespace {

using testing::box;
using testing::Facet;
using testing::Facets;
using testing::prism;
using testing::remesh_surface;
using testing::sphere;
using testing::surface_of;

using Profile = std::vector<std::array<double, 2>>;

// A profile in the plane of x and z, counter-clockwise as seen along y, that its first point sees all of, moved along
// y.
Facets extrusion(const Profile& profile, double length) {
  Facets facets;
  const auto at = [&](std::size_t i, double y) {
    const auto [x, z] = profile[i % profile.size()];
    return Vec3{x, y, z};
  };
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Vec3 a = at(i, 0), b = at(i + 1, 0), c = at(i + 1, length), d = at(i, length);
    facets.insert(facets.end(), {Facet{a, c, b}, Facet{a, d, c}});
    if (i > 0 && i + 1 < profile.size())
      facets.insert(facets.end(), {Facet{at(0, 0), a, b}, Facet{at(0, length), c, d}});
  }
  return facets;
}

// A square of side 6, its corner at the origin rounded by `strips` strips.
Profile filleted(double radius, int strips) {
  Profile profile{{6, 6}, {0, 6}};
  for (int i = 0; i <= strips; ++i) {
    const double angle = std::numbers::pi * (1 + 0.5 * i / strips);
    profile.push_back({radius * (1 + std::cos(angle)), radius * (1 + std::sin(angle))});
  }
  profile.push_back({6, 0});
  return profile;
}

FeatureMesh mesh_of(const Facets& facets) {
  return {surface_of(facets), 40};
}

struct Lines {
  double length = 0;
  std::set<long> off;  // their distances from x = z, to 1/1000
};

Lines lines_of(const FeatureMesh& mesh, double size) {
  Lines lines;
  for (const auto e : crest_lines(mesh, size)) {
    lines.length += mesh.calc_edge_length(e);
    const auto h = mesh.halfedge_handle(e, 0);
    for (const auto v : {mesh.from_vertex_handle(h), mesh.to_vertex_handle(h)})
      lines.off.insert(std::lround(1000 * std::abs(mesh.position(v).x - mesh.position(v).z)));
  }
  return lines;
}

TEST(CrestLines, RunAlongTheMiddleOfASmallFillet) {
  const Lines lines = lines_of(mesh_of(extrusion(filleted(0.8, 6), 8)), 1);
  EXPECT_NEAR(lines.length, 8, 1e-9);
  EXPECT_EQ(lines.off, std::set<long>{0});
}

TEST(CrestLines, RunAlongOneSideOfAStripInTheMiddle) {
  const Lines lines = lines_of(mesh_of(extrusion(filleted(0.8, 5), 8)), 1);
  EXPECT_NEAR(lines.length, 8, 1e-9);
  EXPECT_EQ(lines.off.size(), 1u);
  EXPECT_EQ(*lines.off.begin(), std::lround(800 * std::numbers::sqrt2 * std::sin(std::numbers::pi / 20)));
}

TEST(CrestLines, AreNotOnWhatTheSizeResolvesNorOnEdges) {
  EXPECT_EQ(lines_of(mesh_of(extrusion(filleted(0.8, 6), 8)), 0.3).length, 0);
  EXPECT_EQ(lines_of(mesh_of(extrusion(filleted(2.5, 12), 8)), 1).length, 0);
  EXPECT_EQ(lines_of(mesh_of(box({0, 0, 0}, {6, 8, 6}, 4)), 1).length, 0);
  EXPECT_EQ(lines_of(mesh_of(prism(12, 0.6, 8)), 1).length, 0) << "a rod has no edge that was rounded";
  EXPECT_EQ(lines_of(mesh_of(sphere({0, 0, 0}, 1, 12)), 1).length, 0);
}

TEST(CrestLines, AreLongAgainstTheSize) {
  EXPECT_EQ(lines_of(mesh_of(extrusion(filleted(0.8, 6), 3)), 1).length, 0);
}

TEST(CrestLines, AreNotWhereTheSurfaceTurnsBack) {
  // A step of 60 degrees and back.
  const Profile step{{10, 6}, {0, 6}, {0, 0}, {4, 0}, {4.2, 0.12}, {4.35, 0.36}, {4.5, 0.6}, {4.7, 0.72}, {10, 0.72}};
  EXPECT_EQ(lines_of(mesh_of(extrusion(step, 8)), 1).length, 0);
}

TEST(CrestLines, AreNotOnTheRoundRimOfAThinPlate) {
  Profile plate{{6, 0.8}};
  for (int i = 0; i <= 8; ++i) {
    const double angle = std::numbers::pi * (0.5 + i / 8.0);
    plate.push_back({0.4 + 0.4 * std::cos(angle), 0.4 + 0.4 * std::sin(angle)});
  }
  plate.push_back({6, 0});
  EXPECT_EQ(lines_of(mesh_of(extrusion(plate, 8)), 1).length, 0);
}

TEST(BendStretch, IsThatOfTheTangents) {
  FeatureMesh mesh = mesh_of(extrusion(filleted(0.8, 6), 8));
  mesh.add_crests(crest_lines(mesh, 1));
  const FieldSurface surface(mesh, 1);
  const BendStretch stretch = bend_stretch(surface, cross_field(surface));
  int stretched = 0;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(surface.triangles.size()); ++f) {
    const Vec3& n = surface.normals[f];
    const bool on_fillet = std::abs(n.x) > 0.01 && std::abs(n.z) > 0.01;
    stretched += on_fillet;
    EXPECT_NEAR(stretch.in_direction(f, {0, 1, 0}), 1, 1e-9);
    const double across = stretch.in_direction(f, cross(n, Vec3{0, 1, 0}));
    EXPECT_NEAR(across, on_fillet ? 4 / std::numbers::pi : 1, 1e-6);
  }
  EXPECT_EQ(stretched, 12);
}

// A row along the fillet and one along each side's middle, as of the box that was rounded.
TEST(Remesh, TreatsASmallFilletAsAnEdge) {
  const Surface surface = surface_of(extrusion(filleted(0.8, 6), 8));
  const RemeshResult result = remesh_surface(surface, {.size = 1});
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.extra_points, 0u);
  int on_crest = 0, on_side = 0;
  for (const Vec3& p : result.surface.points) {
    on_crest += std::abs(p.x - p.z) < 1e-9 && p.x < 1;
    on_side += std::abs(p.x) < 1e-9 && p.y > 0 && p.y < 8;
  }
  EXPECT_EQ(on_crest, 9);
  EXPECT_EQ(on_side, 6 * 7);
}

// All edges and corners of a box about the origin rounded, by `strips` from the middle of an edge to each side.
Facets rounded_box(const Vec3& half, double radius, int strips) {
  const auto cuts = [&](double h) {
    std::vector<double> result;
    for (int i = 0; i <= strips; ++i)
      result.push_back(h - radius + radius * std::tan(0.25 * std::numbers::pi * i / strips));
    for (int i = 0; i <= strips; ++i) result.insert(result.begin(), -result[2 * i]);
    return result;
  };
  const auto rounded = [&](const Vec3& p) {
    const auto inside = [&](double x, double h) { return std::clamp(x, radius - h, h - radius); };
    const Vec3 q{inside(p.x, half.x), inside(p.y, half.y), inside(p.z, half.z)};
    return q + radius * unit(p - q);
  };
  Facets facets;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> us = cuts(half[(axis + 1) % 3]), vs = cuts(half[(axis + 2) % 3]);
    for (const int side : {-1, 1}) {
      const auto at = [&](std::size_t i, std::size_t j) {
        std::array<double, 3> p{};
        p[static_cast<std::size_t>(axis)] = side * half[axis];
        p[static_cast<std::size_t>((axis + 1) % 3)] = us[i];
        p[static_cast<std::size_t>((axis + 2) % 3)] = vs[j];
        return rounded({p[0], p[1], p[2]});
      };
      for (std::size_t i = 0; i + 1 < us.size(); ++i)
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
          const Vec3 a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
          if (side > 0)
            facets.insert(facets.end(), {Facet{a, b, c}, Facet{a, c, d}});
          else
            facets.insert(facets.end(), {Facet{a, c, b}, Facet{a, d, c}});
        }
    }
  }
  return facets;
}

TEST(Remesh, GivesARoundedBoxNearlyThePointsOfABox) {
  const RemeshResult result = remesh_surface(surface_of(rounded_box({5, 4, 3}, 0.5, 3)), {.size = 1});
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.extra_points, 0u);
  EXPECT_NEAR(static_cast<double>(result.surface.points.size()), 11 * 9 * 7 - 9 * 7 * 5, 16);
}

}  // namespace
}  // namespace hexpipe
