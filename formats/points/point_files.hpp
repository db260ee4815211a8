#pragma once
// Reads files of points: .xyz, TetGen's .node, .npy, and the vertices of a .ply. See formats/README.md.

#include <cstdint>
#include <string>
#include <vector>

#include "common/mesh/vec3.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe::formats {

struct PointList {
  std::vector<Vec3> points;
  std::vector<std::int64_t> lines;  // of each point in a text; empty for other files
  std::string name;                 // of the input, for messages

  // "points.xyz:12" or "points.npy: point 3", to begin a message with.
  std::string place_of(std::size_t point) const;
};

// Recognises the format by the content. Throws FormatError or DataError that names the line or the point.
PointList read_points(Input& input);

}  // namespace hexpipe::formats
