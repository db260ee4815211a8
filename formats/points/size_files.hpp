#pragma once
// Sizes of elements by place: as a list of places, by the vertices of a surface, or on a background mesh. See
// formats/README.md.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/streams/input.hpp"
#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::formats {

struct SizeList {
  static constexpr Vertex none = -1;

  std::vector<double> sizes;  // positive and finite
  std::vector<Vec3> points;   // where they hold; empty: at the vertices of a surface, in the order of its file
  // Of a background mesh, tets or else triangles, the rest `none`: sizes are linear between their corners.
  std::vector<std::array<Vertex, 4>> simplices;
  std::string name;  // of the input, for messages
};

// The format is told by content. Throws FormatError or DataError naming line or number.
SizeList read_sizes(Input& input);

// Gives sizes of vertices the points and triangles of the surface that they were made for. Throws DataError where the
// file of the surface has another number of vertices, or none of its own.
SizeList on_surface(SizeList sizes, const SurfaceSoup& surface);

}  // namespace hexpipe::formats
