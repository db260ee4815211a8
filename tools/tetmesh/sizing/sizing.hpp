#pragma once
// The size of elements: what the user asks for, what the part suggests, and how well the surface goes with it.

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

// "2.5" or "3%". Throws UsageError unless it is positive and finite.
Length parse_length(std::string_view text);

// Of the box around the points, along the axes.
double bounding_box_diagonal(const formats::SurfaceSoup& surface);

// In the units of the surface. Without a length, 5 % of the diagonal, but at most half of the mean wall thickness (2
// volume / area), and at least 1 % of the cube root of the volume. Where the surface's triangles stay as they are, also
// at most the spacing of its vertices (the side of a square for each of them), which is the size that goes with them.
double element_size(const solid::Surface& surface, const std::optional<Length>& length, bool triangles_stay = true);

// About how many points cover the surface at the distances of the field: its area in squares of the size there. Stops
// where they come to more than `enough`.
double points_on_surface(const solid::Surface& surface, const SizeField& size, double enough);

// About how many points fill the material at that distance: its volume in cubes of the size.
double points_expected(const solid::Surface& surface, double size);

// How far the surface's triangles are from the size of the elements behind them, which is that at their centres.
struct SizeFit {
  double median_edge = 0;
  // The part of the area in triangles with an edge longer than 2.5 times the size, or shorter than 0.4 times. The
  // diagonal of a square is 1.4 sizes long.
  double coarse_share = 0, fine_share = 0;

  // A sentence when more than a quarter of the area is off.
  std::optional<std::string> complaint(double size) const;
};

SizeFit fit_to_size(const solid::Surface& surface, const SizeField& size);

}  // namespace hexpipe::tetmesh::sizing
