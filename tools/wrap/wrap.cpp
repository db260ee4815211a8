#include "tools/wrap/wrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/run/error.hpp"
#include "tools/wrap/open_sheets.hpp"
#include "tools/wrap/restoring.hpp"
#include "tools/wrap/shrink_wrap.hpp"
#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {
namespace {

// A share of half the gap. The surface is that far out at first, and stays there if it cannot go to the input; CGAL's
// authors suggest this ratio.
constexpr double offset_of_alpha = 1.0 / 30;

double area_of(const Surface& surface) {
  double area = 0;
  for (const auto& [a, b, c] : surface.triangles)
    area += norm(cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a])) / 2;
  return area;
}

// Empty if there is none.
std::string name_of_hole(const Surface& input) {
  const auto hole = widest_hole(input);
  if (!hole) return {};
  return fmt::format("; its widest hole, {} edges around ({:.6g}, {:.6g}, {:.6g}), is about {:.3g} wide", hole->edges,
                     hole->middle.x, hole->middle.y, hole->middle.z, hole->width);
}

// A wrap around the input, without the sheets that stand out from bodies, as fins do. A wrap of them would be a shell
// that is too thin to be meshed.
struct Wrapped {
  Surface input, surface;
};

Surface without(const Surface& input, const std::vector<char>& left_out) {
  Surface result{input.points, {}};
  for (std::size_t t = 0; t < input.triangles.size(); ++t)
    if (!left_out[t]) result.triangles.push_back(input.triangles[t]);
  return result;
}

Wrapped wrap_bodies(const formats::SurfaceSoup& soup, double alpha, double offset, std::vector<std::string>& warnings) {
  constexpr double most = 0.3, told = 1e-3;
  Wrapped result{{soup.points, soup.triangles}, {}};
  result.surface = shrink_wrap(result.input, alpha, offset);
  const Sheets sheets = find_sheets(result.surface, TriangleTree(result.input), result.input.triangles.size(), offset);
  if (sheets.share > most)
    throw DataError::at(
        soup.name,
        "expected a surface that encloses a room but for gaps up to {:.4g}, found that the outside gets "
        "in, so that only a shell of {:.2g} is left{}; close wider holes by a larger --gap",
        2 * alpha, 2 * offset, name_of_hole(result.input));
  Surface bodies = without(result.input, sheets.is_sheet);
  if (sheets.share < told || area_of(bodies) == area_of(result.input)) return result;
  warnings.push_back(
      fmt::format("{} triangle(s), {:.2g} % of the input's area, have the outside on both sides and are "
                  "left out: they are fins, or the room behind them is open to gaps of {:.4g}{}",
                  result.input.triangles.size() - bodies.triangles.size(),
                  100 * (1 - area_of(bodies) / area_of(result.input)), 2 * alpha, name_of_hole(result.input)));
  result.surface = shrink_wrap(bodies, alpha, offset);
  result.input = std::move(bodies);
  return result;
}

void give_tags(const formats::SurfaceSoup& soup, const TriangleTree& input, formats::SurfaceSoup& surface) {
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 middle = (1.0 / 3) * (surface.points[a] + surface.points[b] + surface.points[c]);
    surface.tags.push_back(soup.tags[input.nearest(middle).triangle]);
  }
  surface.names.surfaces = soup.names.surfaces;
  surface.has_own_tags = soup.has_own_tags;
}

}  // namespace

WrapResult wrap(const formats::SurfaceSoup& soup, const WrapOptions& options) {
  const Surface input{soup.points, soup.triangles};
  if (!(area_of(input) > 0)) throw DataError::at(soup.name, "expected triangles with an area, found none");
  WrapResult result;
  result.gap = options.gap;
  const double alpha = options.gap / 2;
  result.offset = offset_of_alpha * alpha;
  const Wrapped wrapped = wrap_bodies(soup, alpha, result.offset, result.warnings);
  const TriangleTree bodies(wrapped.input), tree(input);

  constexpr double no_features = 180;
  // The ball of radius alpha stays 0.41 alpha away from an inner edge of 90 degrees, 0.73 alpha from an inner corner.
  RestoredSurface restored =
      restore_shape(wrapped.surface, bodies, {0.75 * alpha, options.features ? options.feature_angle : no_features});
  result.points_on_input = restored.points_on_input;
  result.points_off_input = restored.points_off_input;
  result.sharp_points = restored.sharp_points;
  result.slivers = restored.slivers;
  result.to_input = distances(restored.surface, tree, alpha / 2, 2 * result.offset);
  result.from_input = distances(input, TriangleTree(restored.surface), alpha / 2, 2 * result.offset);
  // Less than this is what comes out of rounded corners.
  constexpr double told_share = 0.005;
  if (result.from_input.share_beyond > told_share)
    result.warnings.push_back(fmt::format(
        "{:.1f} % of the input's area is not on the surface but up to {:.3g} away from it: it is inside, in "
        "narrow places, or at rounded edges",
        100 * result.from_input.share_beyond, result.from_input.greatest));
  result.surface.name = soup.name;
  result.surface.points = std::move(restored.surface.points);
  result.surface.triangles = std::move(restored.surface.triangles);
  give_tags(soup, tree, result.surface);
  return result;
}

nlohmann::ordered_json to_json(const WrapResult& result) {
  const auto summary = [](const DistanceSummary& distance) {
    return nlohmann::ordered_json{
        {"greatest", distance.greatest}, {"mean", distance.mean}, {"share_beyond", distance.share_beyond}};
  };
  return {{"triangles", result.surface.triangles.size()},
          {"gap", result.gap},
          {"offset", result.offset},
          {"points_on_input", result.points_on_input},
          {"points_off_input", result.points_off_input},
          {"sharp_points", result.sharp_points},
          {"slivers", result.slivers},
          {"distance_to_input", summary(result.to_input)},
          {"distance_from_input", summary(result.from_input)}};
}

}  // namespace hexpipe::wrap
