#pragma once
// Makes a closed surface near triangles of any kind.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/surfaces/surface_soup.hpp"
#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {

struct WrapOptions {
  double gap;            // holes and gaps narrower than this are closed; detail narrower than this may be lost
  double feature_angle;  // degrees; sharp edges that turn by more come back
  bool features;         // no sharp edges otherwise
};

struct WrapResult {
  formats::SurfaceSoup surface;
  double gap = 0, offset = 0;                             // lengths
  std::size_t points_on_input = 0, points_off_input = 0;  // the latter span gaps, mostly
  std::size_t sharp_points = 0;
  std::size_t slivers = 0;  // nearly flat or folded triangles that had to stay
  DistanceSummary to_input, from_input;
  std::vector<std::string> warnings;
};

// A finer wrap would have more than a hundred million triangles.
inline constexpr double least_gap_of_diagonal = 1e-4;

// Throws DataError where nothing has an area, or where the outside gets in: a hole is wider than the gap, so that the
// wrap would be a thin shell on both sides of the surface.
WrapResult wrap(const formats::SurfaceSoup& soup, const WrapOptions& options);

nlohmann::ordered_json to_json(const WrapResult& result);

}  // namespace hexpipe::wrap
