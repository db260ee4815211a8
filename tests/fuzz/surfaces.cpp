#include <array>
#include <string>

#include "common/run/error.hpp"
#include "formats/surfaces/surface_files.hpp"
#include "tests/fuzz/targets.hpp"
#include "tools/tetmesh/sizing/sizing.hpp"
#include "tools/tetmesh/solid/repair.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"
#include "tools/tetmesh/surface/surface_remesh.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::sizing;
using namespace tetmesh::solid;
using namespace tetmesh::surface;
namespace {

// Larger ones take long under the sanitizers and have no more to show.
constexpr std::size_t most_triangles = 1000, most_to_remesh = 60;
// Shares of the diagonal.
constexpr double weld = 1e-6, size = 0.25;

bool is_boundary_of_a_solid(const SurfaceSoup& soup) {
  try {
    check_surface(soup);
    return true;
  } catch (const DataError&) {
    return false;
  }
}

// As tetmesh does before it calls TetGen. The first byte says whether the surface is repaired (1), mended (16) and made
// anew (8), and what shells in shells mean (0, 2, 4).
void read_as_solid(std::string_view bytes) {
  if (bytes.empty()) return;
  const unsigned choice = static_cast<unsigned char>(bytes.front());
  Input input = Input::from_memory(std::string(bytes.substr(1)), "fuzzed");
  SurfaceSoup soup = read_surface(input);
  if (soup.triangles.size() > most_triangles) return;
  const double diagonal = bounding_box_diagonal(soup);
  if ((choice & 1u) != 0) repair(soup, {weld * diagonal, RepairOptions{}.largest_hole});
  if ((choice & 16u) != 0) mend(soup);
  check_surface(soup);
  constexpr std::array rules{ShellRule::oriented, ShellRule::regions, ShellRule::holes};
  const Surface surface = find_shells(std::move(soup), rules[(choice / 2 % 4) % rules.size()]);
  for (const Shell& shell : surface.shells) promise(shell.volume >= 0, "shells enclose a volume");
  if ((choice & 8u) == 0 || surface.triangles.size() > most_to_remesh) return;
  SurfaceRemesher remesher(surface, {.size = size * diagonal});
  while (remesher.make() && !remesher.judge()) {
  }
  const RemeshResult remeshed = remesher.take();
  promise(!remeshed.failure.empty() || is_boundary_of_a_solid(remeshed.surface), "a new surface bounds a solid");
}

constexpr std::array targets{FuzzTarget{"surface", read_as_solid}};

}  // namespace

std::span<const FuzzTarget> surface_targets() {
  return targets;
}

}  // namespace hexpipe
