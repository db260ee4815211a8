#pragma once
// Reads sizes of elements: for a list of places, for the vertices of a surface, or on a background mesh. See
// formats/README.md.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/streams/input.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::formats {

struct SizeList {
  std::vector<double> sizes;  // positive and finite
  std::vector<Vec3> points;   // the places of the sizes; empty: the vertices of a surface, in the order of its file
  // The tets of a background mesh, or its triangles, whose last corner is no_index. Sizes are linear between the
  // corners.
  std::vector<std::array<Vertex, 4>> simplices;
  std::string name;  // of the input, for messages
};

// Recognises the format by the content. Throws FormatError or DataError that names the line or the number.
SizeList read_sizes(Input& input);

// Gives sizes by vertex the points and triangles of the surface that they were made for. Throws DataError when the file
// of the surface has another number of vertices, or a format without vertices.
SizeList on_surface(SizeList sizes, const SurfaceSoup& surface);

}  // namespace hexpipe::formats
