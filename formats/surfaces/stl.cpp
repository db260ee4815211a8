#include "formats/surfaces/stl.hpp"

#include <bit>
#include <cstring>
#include <utility>

#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

constexpr std::size_t header_bytes = 80;
constexpr std::size_t first_facet = header_bytes + 4;
constexpr std::size_t facet_bytes = 50;  // normal, three vertices (3 f4 each), attribute (u2)
static_assert(std::endian::native == std::endian::little, "binary STL is read in place");

std::uint64_t facet_count(std::string_view bytes) {
  std::uint32_t count;
  std::memcpy(&count, &bytes[header_bytes], sizeof count);
  return count;
}

void read_facet(TextScanner& scanner, std::int32_t tag, PointMerger& merger, SurfaceSoup& soup) {
  const long line = scanner.line();
  scanner.expect("facet");
  scanner.rest_of_line();
  scanner.expect("outer");
  scanner.expect("loop");
  Triangle triangle;
  for (Vertex& corner : triangle) {
    scanner.expect("vertex");
    corner = merger.index_of(read_coordinates(scanner));
  }
  scanner.expect("endloop");
  scanner.expect("endfacet");
  append_triangle(soup, triangle, tag, line);
}

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= first_facet && bytes.size() == first_facet + facet_bytes * facet_count(bytes);
}

SurfaceSoup read_ascii_stl(std::string_view text, const std::string& name) {
  SurfaceSoup soup;
  PointMerger merger(soup.points);
  TextScanner scanner(text, name);
  std::int32_t solid = 0;
  while (!scanner.at_end()) {
    scanner.expect("solid");
    std::string title = clean_name(scanner.rest_of_line());
    ++solid;
    // peek_word() skips to the word, so that line() is the facet's.
    while (!equal_ignoring_case(scanner.peek_word(), "endsolid")) {
      if (!equal_ignoring_case(scanner.peek_word(), "facet"))
        scanner.fail_expected("'facet' or 'endsolid'", scanner.peek_word());
      read_facet(scanner, solid, merger, soup);
    }
    scanner.expect("endsolid");
    scanner.rest_of_line();
    if (!title.empty()) soup.names.surfaces[solid] = std::move(title);
  }
  return soup;
}

SurfaceSoup read_binary_stl(std::string_view bytes, const std::string& name) {
  if (bytes.size() < first_facet)
    throw DataError::at(name, "expected the {} bytes of a binary STL header, found {}", first_facet, bytes.size());
  const std::uint64_t count = facet_count(bytes);
  if (!is_binary_stl(bytes))
    throw DataError::at(name, "expected {} bytes of binary STL for {} facets, found {}",
                        first_facet + facet_bytes * count, count, bytes.size());
  SurfaceSoup soup;
  soup.text = false;
  soup.triangles.reserve(count), soup.tags.reserve(count), soup.places.reserve(count);
  PointMerger merger(soup.points);
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* facet = &bytes[first_facet + facet_bytes * i];
    float xyz[9];
    std::uint16_t attribute;
    std::memcpy(xyz, facet + 3 * sizeof(float), sizeof xyz);
    std::memcpy(&attribute, facet + 12 * sizeof(float), sizeof attribute);
    Triangle triangle;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3 point{xyz[3 * corner], xyz[3 * corner + 1], xyz[3 * corner + 2]};
      if (!is_place(point))
        throw DataError::at(name, "triangle {}: expected coordinates up to {}, found {}, {}, {}", i + 1,
                            largest_coordinate, point.x, point.y, point.z);
      triangle[corner] = merger.index_of(point);
    }
    append_triangle(soup, triangle, attribute, static_cast<std::int64_t>(i) + 1);
  }
  return soup;
}

}  // namespace hexpipe::formats
