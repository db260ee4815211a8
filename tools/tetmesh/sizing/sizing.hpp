#pragma once
// The size of elements: as the user writes it, as the model suggests it, and how well the surface's triangles suit it.

#include <optional>
#include <string>
#include <string_view>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::sizing {

struct Length {
  double value = 0;
  bool percent_of_diagonal = false;
};

// Reads "2.5" or "3%". Throws UsageError unless the number is positive and finite.
Length parse_length(std::string_view text);

// The length in the units of the surface.
double in_units(const Length& length, const formats::SurfaceSoup& surface);

// The diagonal of the box around the points, along the axes.
double bounding_box_diagonal(const formats::SurfaceSoup& surface);

// The size in the units of the surface. Without a length, it is that of common/mesh/defaults.hpp. If the surface's
// triangles stay as they are, it is also at most the spacing of the vertices (the side of a square for each of them),
// because that size suits them.
double element_size(const solid::Surface& surface, const std::optional<Length>& length, bool triangles_stay = true);

// Twice the volume over the area.
double mean_wall_thickness(const solid::Surface& surface);

// Estimates how many points cover the surface at the distances of the field: its area in squares of the size there.
// Stops when they come to more than `enough`.
double points_on_surface(const solid::Surface& surface, const SizeField& size, double enough);

// Estimates how many points fill the material at this distance: its volume in cubes of the size.
double points_expected(const solid::Surface& surface, double size);

// How well the surface's triangles suit the size of the elements behind them, which is the size at their centres.
struct SizeFit {
  double median_edge = 0;
  // The shares of the area in triangles with an edge longer than 2.5 sizes, and with an edge shorter than 0.4 sizes.
  // (The diagonal of a square is 1.4 sizes long.)
  double coarse_share = 0, fine_share = 0;

  // A sentence if more than a quarter of the area is off.
  std::optional<std::string> complaint(double size) const;
};

SizeFit fit_to_size(const solid::Surface& surface, const SizeField& size);

}  // namespace hexpipe::tetmesh::sizing
