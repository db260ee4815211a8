#include "tools/tetmesh/sizing/size_demand.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "common/mesh/defaults.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/sizing/wall_sizes.hpp"

namespace hexpipe::tetmesh::sizing {
namespace {

// The least size that bends ask for, as a part of the greatest size.
constexpr double least_of_greatest = 0.2;
// An edge that turns by less, in radians, is flat.
constexpr double flat_angle = 1e-3;

double greatest_size(const solid::Surface& surface, const SizeRequest& request, bool triangles_stay) {
  if (request.size || request.sources.empty()) return element_size(surface, request.size, triangles_stay);
  return std::ranges::max(request.sources.sizes);
}

// Takes the radius of a bend from two neighbouring triangles: the distance between their outer corners, measured from
// the common edge, over the angle by which they turn.
void add_curvature_sizes(const solid::Surface& surface, double elements_in_a_turn, double least, double greatest,
                         double feature_angle, SizeSources& sources) {
  const double feature_cosine = cosine_of_degrees(feature_angle);
  geometry::for_each_edge(surface.points.size(), surface.triangles, [&](std::span<const geometry::HalfEdge> edge) {
    if (edge.size() != 2) return;
    const Vec3& a = surface.points[geometry::start_of(surface.triangles, edge[0])];
    const Vec3& b = surface.points[geometry::end_of(surface.triangles, edge[0])];
    std::array<Vec3, 2> areas;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto [p, q, r] = surface.triangles[geometry::triangle_of(edge[i])];
      areas[i] = cross(surface.points[q] - surface.points[p], surface.points[r] - surface.points[p]);
    }
    const double cosine = dot(unit(areas[0]), unit(areas[1]));
    if (cosine < feature_cosine) return;
    const double angle = std::atan2(norm(cross(unit(areas[0]), unit(areas[1]))), cosine);
    const double width = (norm(areas[0]) + norm(areas[1])) / 2 / norm(b - a);
    const double size = std::max(least, 2 * std::numbers::pi / elements_in_a_turn * width / angle);
    if (angle < flat_angle || size >= greatest) return;
    const auto first = static_cast<Vertex>(sources.points.size());
    sources.points.insert(sources.points.end(), {a, b});
    sources.sizes.insert(sources.sizes.end(), 2, size);
    sources.simplices.push_back({first, first + 1, no_index, no_index});
  });
}

}  // namespace

SizeDemand operator*(double factor, SizeDemand demand) {
  demand.greatest *= factor;
  for (double& size : demand.sources.sizes) size *= factor;
  return demand;
}

SizeDemand demand_on(const solid::Surface& surface, const SizeRequest& request, double feature_angle,
                     bool triangles_stay) {
  SizeDemand demand{greatest_size(surface, request, triangles_stay), request.sources, request.grading, request.layers};
  if (request.curvature) {
    const double least = request.least ? element_size(surface, request.least) : least_of_greatest * demand.greatest;
    add_curvature_sizes(surface, *request.curvature, least, demand.greatest, feature_angle, demand.sources);
  }
  return demand;
}

SizeField field_of(const solid::Surface& surface, SizeDemand demand) {
  if (demand.layers) demand.sources.prisms = wall_sizes(surface, demand.greatest, *demand.layers);
  return {std::move(demand.sources), demand.greatest, demand.grading};
}

}  // namespace hexpipe::tetmesh::sizing
