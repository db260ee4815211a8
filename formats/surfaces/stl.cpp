#include "formats/surfaces/stl.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
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

// Numbers that could be coordinates, not bytes of some other file.
bool may_be_facet(const char* facet) {
  constexpr float greatest = 1e30f, least = 1e-37f;
  float xyz[9];
  std::memcpy(xyz, facet + 3 * sizeof(float), sizeof xyz);
  return std::ranges::all_of(xyz, [](float x) { return x == 0 || (std::fabs(x) < greatest && std::fabs(x) > least); });
}

// The whole facets behind the header: there are some, and the first could all be facets.
bool may_be_facets(std::string_view facets) {
  constexpr std::size_t enough = 20;
  const std::size_t count = std::min(facets.size() / facet_bytes, enough);
  for (std::size_t i = 0; i < count; ++i)
    if (!may_be_facet(&facets[facet_bytes * i])) return false;
  return count > 0;
}

bool has_only_zeros(std::string_view bytes) {
  return bytes.find_first_not_of('\0') == std::string_view::npos;
}

// The number of facets that are there; adds a warning where the length says something else. Throws DataError where they
// are cut off, or where more of them than were counted follow.
std::uint64_t check_length(std::string_view bytes, SurfaceSoup& soup) {
  const std::uint64_t count = facet_count(bytes), room = (bytes.size() - first_facet) / facet_bytes;
  const std::size_t over = (bytes.size() - first_facet) % facet_bytes;
  if (count > room)
    throw DataError::at(soup.name, "expected {} bytes of binary STL for {} facets, found {}",
                        first_facet + facet_bytes * count, count, bytes.size());
  if (count == 0 && over == 0 && may_be_facets(bytes.substr(first_facet))) {
    soup.warnings.push_back(fmt::format("{}: the header counts 0 facets, the length is that of {}", soup.name, room));
    return room;
  }
  const std::string_view rest = bytes.substr(first_facet + facet_bytes * count);
  if (rest.empty()) return count;
  if (over == 0 && may_be_facets(rest) && !has_only_zeros(rest))
    throw DataError::at(soup.name, "expected {} facets of binary STL as the header says, found {}", count, room);
  soup.warnings.push_back(fmt::format("{}: left out {} byte{} behind the last of {} facets", soup.name, rest.size(),
                                      rest.size() == 1 ? "" : "s", count));
  return count;
}

// "endsolid" or "end solid".
bool is_end(TextScanner scanner, std::string_view of) {
  if (equal_ignoring_case(scanner.peek_word(), std::string("end").append(of))) return true;
  if (!equal_ignoring_case(scanner.peek_word(), "end")) return false;
  scanner.word("end");
  return equal_ignoring_case(scanner.peek_word(), of);
}

void expect_end(TextScanner& scanner, std::string_view of) {
  if (equal_ignoring_case(scanner.peek_word(), "end")) {
    scanner.expect("end");
    scanner.expect(of);
  } else {
    scanner.expect(std::string("end").append(of));
  }
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
  expect_end(scanner, "loop");
  expect_end(scanner, "facet");
  append_triangle(soup, triangle, tag, line);
}

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= first_facet && bytes.size() == first_facet + facet_bytes * facet_count(bytes);
}

bool may_be_binary_stl(std::string_view bytes) {
  if (bytes.size() < first_facet + facet_bytes) return false;
  const std::uint64_t room = (bytes.size() - first_facet) / facet_bytes;
  const bool is_counted = facet_count(bytes) > 0 || (bytes.size() - first_facet) % facet_bytes == 0;
  return is_counted && facet_count(bytes) <= room && may_be_facets(bytes.substr(first_facet));
}

// Half a billion facets are 25 GB: a larger count is made of other bytes.
bool is_cut_binary_stl(std::string_view bytes) {
  constexpr std::uint64_t most = 1u << 29;
  if (bytes.size() < first_facet || bytes.size() >= first_facet + facet_bytes * facet_count(bytes)) return false;
  if (facet_count(bytes) > most) return false;
  return bytes.size() < first_facet + facet_bytes ? bytes.starts_with("solid") || has_only_zeros(bytes.substr(40, 40))
                                                  : may_be_facets(bytes.substr(first_facet));
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
    while (!is_end(scanner, "solid")) {
      if (!equal_ignoring_case(scanner.peek_word(), "facet"))
        scanner.fail_expected("'facet' or 'endsolid'", scanner.peek_word());
      read_facet(scanner, solid, merger, soup);
    }
    expect_end(scanner, "solid");
    scanner.rest_of_line();
    if (!title.empty()) soup.names.surfaces[solid] = std::move(title);
  }
  return soup;
}

SurfaceSoup read_binary_stl(std::string_view bytes, const std::string& name) {
  if (bytes.size() < first_facet)
    throw DataError::at(name, "expected the {} bytes of a binary STL header, found {}", first_facet, bytes.size());
  SurfaceSoup soup;
  soup.name = name;
  soup.text = false;
  const std::uint64_t count = check_length(bytes, soup);
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
