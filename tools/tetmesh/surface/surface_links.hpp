#pragma once
// What the triangles of a surface see of their neighbours along a cross field.

#include <array>
#include <span>
#include <vector>

#include "tools/tetmesh/periodic_numbers.hpp"
#include "tools/tetmesh/surface/cross_field.hpp"

namespace hexpipe {

// Direction k here is direction k there, or the other one where crossed, turned round where flipped, and `distance[k]`
// further on.
struct SurfaceLink {
  std::array<double, 2> distance{};  // between the centres, in sizes
  std::array<Complex, 2> turn{};     // by these
  std::array<bool, 2> flipped{};
  bool crossed = false;
  std::int32_t neighbour = -1;
  double weight = 0;
};

// Of every half-edge, from its triangle to that beyond it; without a neighbour where it is a feature. Distances are
// corrected so that they add up around vertices. `centres` and `sizes` are those of the triangles.
std::vector<SurfaceLink> surface_links(const FieldSurface& surface, const CrossField& field,
                                       std::span<const Vec3> centres, std::span<const double> sizes);

}  // namespace hexpipe
