#include "tools/tetmesh/volume/given_points.hpp"

#include <fmt/format.h>

#include "tools/tetmesh/geometry/sized_point_grid.hpp"
#include "tools/tetmesh/solid/surface_clearance.hpp"

namespace hexpipe::tetmesh::volume {

GivenPoints usable_points(const solid::Surface& surface, const formats::PointList& list, double clearance) {
  const solid::SurfaceClearance clear(surface);
  geometry::SizedPointGrid taken(geometry::Box::around(surface.points));
  std::size_t left_out = 0, first = 0;
  for (std::size_t i = 0; i < list.points.size(); ++i) {
    const Vec3& p = list.points[i];
    bool is_usable = clear.is_inside(p) && clear.is_clear(p, clearance);
    if (is_usable)
      taken.for_each_near(p, 0, 0, [&](std::int32_t other) { return is_usable = taken.points()[other] != p; });
    if (is_usable)
      taken.add(p, clearance);
    else if (left_out++ == 0)
      first = i;
  }
  GivenPoints given{taken.points(), {}};
  if (left_out > 0)
    given.complaint = fmt::format(
        "{}: left out {} of {} points, which are outside, within {:.3g} of the surface, or repeated; the first is here",
        list.place_of(first), left_out, list.points.size(), clearance);
  return given;
}

}  // namespace hexpipe::tetmesh::volume
