#include "formats/surfaces/surface_building.hpp"

#include <bit>
#include <limits>

#include "common/run/error.hpp"

namespace hexpipe::formats {

std::size_t PointMerger::Hash::operator()(const Vec3& p) const {
  // Multiplication spreads low bits upwards, rotation brings them back: coordinates of a grid differ in few bits.
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis)
    hash = std::rotl((hash ^ std::bit_cast<std::uint64_t>(p[axis])) * 0x9e3779b97f4a7c15u, 29);
  return hash;
}

Vertex PointMerger::index_of(const Vec3& point) {
  // -0 + 0 = 0: the two zeros are one coordinate.
  const Vec3 key = point + Vec3{0, 0, 0};
  const auto [entry, is_new] = indices_.try_emplace(key, static_cast<Vertex>(points_.size()));
  if (is_new) {
    if (points_.size() == std::numeric_limits<Vertex>::max()) throw DataError("expected fewer than 2^31 points");
    points_.push_back(key);
  }
  return entry->second;
}

void check_point_count(std::uint64_t count, std::string_view name) {
  if (count > static_cast<std::uint64_t>(std::numeric_limits<Vertex>::max()))
    throw DataError::at(name, "expected fewer than 2^31 points, found {}", count);
}

SurfaceSoup merge_equal_points(SurfaceSoup soup) {
  std::vector<Vec3> merged;
  PointMerger merger(merged);
  std::vector<Vertex> new_index(soup.points.size(), no_index);
  soup.file_vertices.clear();
  for (Triangle& triangle : soup.triangles) {
    for (Vertex& corner : triangle) {
      Vertex& index = new_index[corner];
      if (index == no_index) index = merger.index_of(soup.points[corner]);
      if (merged.size() > soup.file_vertices.size()) soup.file_vertices.push_back(corner);
      corner = index;
    }
  }
  renumber_curves(soup, new_index);
  soup.file_vertex_count = soup.points.size();
  soup.points = std::move(merged);
  return soup;
}

void append_triangle(SurfaceSoup& soup, const Triangle& triangle, std::int32_t tag, std::int64_t place) {
  soup.triangles.push_back(triangle);
  soup.tags.push_back(tag);
  soup.places.push_back(place);
}

void PolygonReader::append(SurfaceSoup& soup, std::span<const Vertex> corners, std::int32_t tag, std::int64_t place) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    append_triangle(soup, {corners[0], corners[i - 1], corners[i]}, tag, place);
    goes_on_.push_back(i > 2);
  }
}

void PolygonReader::cut_concave(SurfaceSoup& soup) const {
  for (std::size_t begin = 0, end = 0; begin < goes_on_.size(); begin = end) {
    for (end = begin + 1; end < goes_on_.size() && goes_on_[end];) ++end;
    if (end - begin > 1) cut_if_concave(soup.points, std::span(soup.triangles).subspan(begin, end - begin));
  }
}

Vec3 read_coordinates(TextScanner& scanner) {
  const auto x = number_on_line<double>(scanner, "a finite coordinate");
  const auto y = number_on_line<double>(scanner, "a finite coordinate");
  const auto z = number_on_line<double>(scanner, "a finite coordinate");
  return {x, y, z};
}

}  // namespace hexpipe::formats
