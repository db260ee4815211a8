#include "tools/wrap/surface.hpp"

#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version_macros.h>
#if CGAL_VERSION_MAJOR >= 6
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_triangle_primitive_3.h>
#else
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_triangle_primitive.h>
#endif

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace hexpipe::wrap {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
#if CGAL_VERSION_MAJOR >= 6
using Primitive = CGAL::AABB_triangle_primitive_3<Kernel, Triangles::const_iterator>;
using Boxes = CGAL::AABB_tree<CGAL::AABB_traits_3<Kernel, Primitive>>;
#else
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Boxes = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
#endif

Kernel::Point_3 to_cgal(const Vec3& p) {
  return {p.x, p.y, p.z};
}
Vec3 from_cgal(const Kernel::Point_3& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

struct TriangleTree::Tree {
  Triangles triangles;
  std::vector<std::int32_t> numbers;  // in the surface
  Boxes boxes;
};

TriangleTree::TriangleTree(const Surface& surface) : tree_(std::make_unique<Tree>()) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const Kernel::Triangle_3 triangle(to_cgal(surface.points[a]), to_cgal(surface.points[b]),
                                      to_cgal(surface.points[c]));
    if (triangle.is_degenerate()) continue;
    tree_->triangles.push_back(triangle);
    tree_->numbers.push_back(static_cast<std::int32_t>(t));
  }
  tree_->boxes.rebuild(tree_->triangles.cbegin(), tree_->triangles.cend());
}

TriangleTree::~TriangleTree() = default;

NearestPoint TriangleTree::nearest(const Vec3& from) const {
  const auto [point, place] = tree_->boxes.closest_point_and_primitive(to_cgal(from));
  return {from_cgal(point), tree_->numbers[place - tree_->triangles.cbegin()]};
}

Plane TriangleTree::nearest_plane(const Vec3& from, const Vec3& towards) const {
  const auto [point, place] = tree_->boxes.closest_point_and_primitive(to_cgal(from));
  const Vec3 a = from_cgal(place->vertex(0));
  const Vec3 normal = unit(cross(from_cgal(place->vertex(1)) - a, from_cgal(place->vertex(2)) - a));
  return {from_cgal(point), dot(normal, towards) < 0 ? -1.0 * normal : normal};
}

Plane TriangleTree::facing_plane(const Vec3& at, const Vec3& towards, double reach) const {
  const Vec3 far{reach, reach, reach};
  std::vector<Triangles::const_iterator> around;
  tree_->boxes.all_intersected_primitives(Kernel::Iso_cuboid_3(to_cgal(at - far), to_cgal(at + far)),
                                          std::back_inserter(around));
  // In the order of the file, so that the first of equals is always the same.
  std::sort(around.begin(), around.end());
  Plane best{at, towards};
  double most = -1;
  for (const auto& place : around) {
    const Vec3 a = from_cgal(place->vertex(0)), b = from_cgal(place->vertex(1)), c = from_cgal(place->vertex(2));
    const Vec3 normal = cross(b - a, c - a);
    const double length = norm(normal);
    if (!(length > 0)) continue;
    const double facing = dot(normal, towards) / length;
    if (std::abs(facing) <= most) continue;
    most = std::abs(facing);
    best = {a, (facing < 0 ? -1 / length : 1 / length) * normal};
  }
  return best;
}

}  // namespace hexpipe::wrap
