#pragma once
// The lines along which rows of points end, made of the straight segments that a bundle has.

#include <vector>

#include "common/mesh/vec3.hpp"
#include "formats/pipeline/stage_data.hpp"

namespace hexpipe::viewmesh {

using Polyline = std::vector<Vec3>;

// Segments that share an end go on in one line, up to where three or more meet. The longest line comes first; a closed
// one ends where it begins.
std::vector<Polyline> join_segments(const pipeline::DislocationSegments& segments);

double length_of(const Polyline& line);

}  // namespace hexpipe::viewmesh
