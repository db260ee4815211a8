#include "tools/tetmesh/surface/delaunay_flips.hpp"

#include <algorithm>
#include <cmath>

namespace hexpipe::tetmesh::surface {
namespace {

// With a positive excess, rounding cannot flip the diagonal of a square back and forth.
constexpr double least_excess = 1e-9;

// The cosine and the sine of the angle at p, times the lengths of its sides.
struct Angle {
  double cosine, sine;
  Angle(const Vec3& p, const Vec3& a, const Vec3& b) : cosine(dot(a - p, b - p)), sine(norm(cross(a - p, b - p))) {}
};

}  // namespace

EdgeDiamond::EdgeDiamond(const FeatureMesh& mesh, OpenMesh::EdgeHandle e) {
  const auto h = mesh.halfedge_handle(e, 0), twin = mesh.halfedge_handle(e, 1);
  ends = {mesh.from_vertex_handle(h), mesh.to_vertex_handle(h)};
  across = {mesh.to_vertex_handle(mesh.next_halfedge_handle(h)),
            mesh.to_vertex_handle(mesh.next_halfedge_handle(twin))};
  for (std::size_t i = 0; i < 2; ++i) {
    end_points[i] = mesh.position(ends[i]);
    across_points[i] = mesh.position(across[i]);
  }
}

bool EdgeDiamond::is_beyond_delaunay() const {
  const Angle left(across_points[0], end_points[0], end_points[1]),
      right(across_points[1], end_points[0], end_points[1]);
  const double sine = -(left.sine * right.cosine + left.cosine * right.sine);
  if (!(sine > 0)) return false;  // nearly always
  const double scale = std::hypot(left.cosine, left.sine) * std::hypot(right.cosine, right.sine);
  return sine / std::max(scale, 1e-300) > least_excess;
}

double EdgeDiamond::height() const {
  const Vec3 edge = end_points[1] - end_points[0], diagonal = across_points[1] - across_points[0];
  const Vec3 normal = cross(edge, diagonal);
  const double length = norm(normal);
  // The two edges are nearly parallel only where a flip is refused anyway.
  if (length <= 1e-12 * norm(edge) * norm(diagonal)) return norm(edge);
  return std::abs(dot(across_points[0] - end_points[0], normal)) / length;
}

double EdgeDiamond::least_cosine_after_flip() const {
  const auto [a, b] = end_points;
  const auto [left, right] = across_points;
  const Vec3 before = cross(b - a, left - a) + cross(right - a, b - a);
  const Vec3 first = cross(right - a, left - a), second = cross(left - b, right - b);
  auto cosine = [&](const Vec3& n) { return dot(n, before) / std::max(norm(n) * norm(before), 1e-300); };
  return std::min(cosine(first), cosine(second));
}

}  // namespace hexpipe::tetmesh::surface
