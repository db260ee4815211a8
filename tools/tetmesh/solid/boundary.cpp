#include "tools/tetmesh/solid/boundary.hpp"

#include <fmt/format.h>

#include <utility>

#include "tools/tetmesh/solid/sheets.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"

namespace hexpipe::tetmesh::solid {

Surface boundary_of(formats::SurfaceSoup soup, ShellRule rule, std::string_view remedy,
                    std::vector<std::string>& warnings) {
  if (meets_in_sheets(soup)) {
    check_areas(soup, remedy);
    const bool has_sides = !soup.sides.empty();
    const SheetReport found = has_sides ? join_bodies(soup) : find_sides(soup, rule, remedy);
    for (const std::string& sentence : found.sentences())
      warnings.push_back(fmt::format("{}: {}", soup.name, sentence));
  }
  if (meets_in_sheets(soup)) return find_sheets(std::move(soup));
  check_surface(soup, remedy);
  return find_shells(std::move(soup), rule);
}

}  // namespace hexpipe::tetmesh::solid
