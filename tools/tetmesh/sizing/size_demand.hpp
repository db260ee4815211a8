#pragma once
// The sizes that the user asks for, as lengths on one model.

#include <optional>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/sizing/sizing.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::sizing {

struct SizeRequest {
  std::optional<Length> size = {};       // the greatest; nothing: the greatest of `sources`, or what suits the model
  SizeSources sources = {};              // sizes at places
  std::optional<double> curvature = {};  // elements in a turn where the surface bends; nothing: bends do not count
  std::optional<Length> least = {};      // the least size that bends ask for; nothing: a fifth of the greatest size
  double grading = 0.3;
  std::optional<int> layers = {};  // the least number of elements across thin walls; nothing: walls do not count
};

struct SizeDemand {
  double greatest = 1;
  SizeSources sources = {};  // without walls
  double grading = SizeRequest{}.grading;
  std::optional<int> layers = {};

  friend SizeDemand operator*(double factor, SizeDemand demand);
};

// Adds the sizes at bends to the places that the request has. Edges that turn by more than `feature_angle` degrees are
// no bends. `triangles_stay`: see element_size().
SizeDemand demand_on(const solid::Surface& surface, const SizeRequest& request, double feature_angle,
                     bool triangles_stay);

// Measures the walls, if the demand has layers.
SizeField field_of(const solid::Surface& surface, SizeDemand demand);

}  // namespace hexpipe::tetmesh::sizing
