#pragma once
// Shared by the readers of surface formats: they merge equal points, cut polygons, and read finite coordinates.

#include <tsl/robin_map.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "formats/streams/text_scanner.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::formats {

// Gives each distinct coordinate triple an index, in the order in which they first appear.
class PointMerger {
 public:
  explicit PointMerger(std::vector<Vec3>& points) : points_(points) {}
  Vertex index_of(const Vec3& point);

 private:
  struct Hash {
    std::size_t operator()(const Vec3& p) const;
  };
  std::vector<Vec3>& points_;
  tsl::robin_map<Vec3, Vertex, Hash> indices_;
};

// The soup with one point instead of equal ones, in the order of first use, and without points that no triangle uses.
// Curves must be edges of triangles.
SurfaceSoup merge_equal_points(SurfaceSoup soup);

// Throws DataError where there are more points than can be numbered.
void check_point_count(std::uint64_t count, std::string_view name);

void append_triangle(SurfaceSoup& soup, const Triangle& triangle, std::int32_t tag, std::int64_t place);

// `fan` has the triangles of one polygon, fanned from its first corner. If one of them is turned against the polygon,
// as happens where it is concave, cuts the polygon again into as many triangles, by cutting off ears in the projection
// along an axis (G. H. Meisters: Polygons have ears, 1975). A polygon without ears, because it crosses itself, or with
// more than 10,000 corners stays a fan. The time grows with the square of the number of corners.
void cut_if_concave(std::span<const Vec3> points, std::span<Triangle> fan);

// Collects the polygons of a file that may have faces before the vertices.
class PolygonReader {
 public:
  // Appends a polygon of at least three corners as a fan.
  void append(SurfaceSoup& soup, std::span<const Vertex> corners, std::int32_t tag, std::int64_t place);
  // Cuts concave polygons again. Call it when all points are there and corners are known to be among them.
  void cut_concave(SurfaceSoup& soup) const;

 private:
  std::vector<bool> goes_on_;  // by triangle: it belongs to the polygon of the triangle before it
};

// Reads three words as coordinates. Throws FormatError where one is missing, not a number, or not finite.
Vec3 read_coordinates(TextScanner& scanner);

// Reads a number on the present line. Throws FormatError at the end of the line.
template <class T>
T number_on_line(TextScanner& scanner, std::string_view what) {
  if (scanner.at_line_end()) scanner.fail(fmt::format("expected {}, found the end of the line", what));
  return scanner.number<T>(what);
}

}  // namespace hexpipe::formats
