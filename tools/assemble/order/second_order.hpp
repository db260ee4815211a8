#pragma once
// assemble --order 2: from a result with straight edges to one of second order, bent with the surface.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "common/curved/bend.hpp"
#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/order/fit_corners.hpp"
#include "tools/assemble/order/given_surface.hpp"

namespace hexpipe::assemble::order {

struct SecondOrderCounts {
  std::int64_t nodes = 0;   // behind the corners
  std::int64_t curves = 0;  // of the boundary's: on sharp edges and borders of tags
  std::int64_t strays = 0;  // nodes of the boundary without a place on the given surface
  std::int64_t placed = 0;  // nodes of the boundary that lie on it
  bool has_surface = false;
  FitCounts corners;
  curved::BendCounts bending;
};

// Adds the nodes; `full`: those of quads and hexes, too. With a surface, nodes of the boundary lie on it, and those of
// sharp edges on its curves; without one, or where it is too far away, on arcs through the boundary's vertices.
SecondOrderCounts make_second_order(MixedMesh& mesh, bool full, const GivenSurface* surface);

nlohmann::ordered_json to_json(const SecondOrderCounts& counts);
std::string summary_line(const SecondOrderCounts& counts);

}  // namespace hexpipe::assemble::order
