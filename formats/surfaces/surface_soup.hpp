#pragma once
// Surfaces as they come: triangle soups from STL, OBJ, PLY, OFF and bundles, with the line or the number of every
// triangle, so that later checks can name a place.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "formats/streams/group_names.hpp"

namespace hexpipe::formats {

// The ends of an edge of some triangles.
using CurveEdge = std::array<Vertex, 2>;

struct SurfaceSoup {
  std::vector<Vec3> points;         // one for each distinct coordinate triple (exact equality, -0 = 0)
  std::vector<Triangle> triangles;  // polygons are cut into as many as a fan would have
  std::vector<std::int32_t>
      tags;  // surface tag: number of the STL solid, STL attribute, number of the OBJ group, otherwise 0
  std::vector<std::int64_t> places;  // line (text) or number in the file (binary) of each triangle's facet, from 1
  bool text = true;                  // what `places` counts
  // By point, its vertex in the file (the first of equal ones), and how many vertices the file has. Empty for formats
  // that repeat the coordinates in every triangle, and when points have been changed.
  std::vector<Vertex> file_vertices = {};
  std::size_t file_vertex_count = 0;
  std::string name;  // of the input, for messages
  // For each triangle: the region that its normal points away from and the one that it points to; 0 outside. Empty if
  // the format does not tell.
  std::vector<std::array<std::int32_t, 2>> sides = {};
  // Edges of the CAD's own curves; they are features even where the surface hardly turns.
  std::vector<CurveEdge> curves = {};
  std::vector<std::int32_t> curve_tags = {};
  bool from_bundle = false;
  bool has_own_tags = false;  // tags that say something even where all triangles have the same
  GroupNames names = {};
  std::vector<std::string> warnings = {};  // sentences about what the reader mended or left out

  // "part.stl:12" or "part.stl: triangle 3", to begin a message with.
  std::string place_of(std::size_t triangle) const;
  // "12" or "3": a place as it is listed inside a message, see place_unit().
  const char* place_unit() const { return text ? "line" : "triangle"; }
};

// Drops the edges of curves for which keeps(edge) is false, with their tags.
void keep_curves_if(SurfaceSoup& soup, const std::function<bool(const CurveEdge&)>& keeps);

// Gives the ends of curves new numbers, by point. Drops edges that became points, or have an end without a number.
void renumber_curves(SurfaceSoup& soup, std::span<const Vertex> number);

// Checks what all readers promise: there are triangles, not too many, of a size that allows computation.
void check_extent(const SurfaceSoup& soup);

}  // namespace hexpipe::formats
