#include "tools/tetmesh/solid/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/tetmesh/solid/borders.hpp"
#include "tools/tetmesh/solid/sheets.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

// Whether the soup says that triangles have the same on both sides.
bool tells_fins(const formats::SurfaceSoup& soup) {
  return std::ranges::any_of(soup.sides, [](const auto& sides) { return sides[0] == sides[1]; });
}

}  // namespace

Surface boundary_of(formats::SurfaceSoup soup, ShellRule rule, BaffleRule baffles, std::string_view remedy,
                    std::vector<std::string>& warnings) {
  const auto is_in_sheets = [&] {
    return meets_in_sheets(soup) || tells_fins(soup) || (baffles == BaffleRule::keep && has_borders(soup));
  };
  std::size_t kept = 0;
  if (is_in_sheets()) {
    check_areas(soup, remedy);
    const bool has_sides = !soup.sides.empty();
    const SheetReport found = has_sides ? join_bodies(soup, baffles) : find_sides(soup, rule, baffles, remedy);
    kept = found.baffles;
    for (const std::string& sentence : found.sentences())
      warnings.push_back(fmt::format("{}: {}", soup.name, sentence));
  }
  if (baffles == BaffleRule::keep && kept == 0)
    warnings.push_back(fmt::format("{}: --keep-baffles finds no sheet that ends inside", soup.name));
  if (is_in_sheets()) return find_sheets(std::move(soup));
  check_surface(soup, remedy);
  return find_shells(std::move(soup), rule);
}

}  // namespace hexpipe::tetmesh::solid
