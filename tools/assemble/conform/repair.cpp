// Slivers with all vertices on the boundary cannot be smoothed: a vertex goes into the space around them, as in the
// vertex insertion of B. M. Klingner, J. R. Shewchuk, "Aggressive tetrahedral mesh improvement" (2007), section 3. The
// cavity grows greedily over the worst facets (cavity.hpp) in place of their minimum cut.

#include "tools/assemble/conform/repair.hpp"

#include "tools/assemble/conform/cavity.hpp"

namespace hexpipe::assemble::conform {
namespace {

// Below this the cavity goes on growing.
constexpr double good_cavity = 0.2;
// What the worst tet has to gain to be worth a vertex: a part of it, and more than rounding.
constexpr double least_ratio = 1.5;
constexpr double least_gain = 0.005;

}  // namespace

std::int64_t repair_flat_tets(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, double least) {
  std::int64_t added = 0;
  const auto count = static_cast<std::int32_t>(mesh.tet_count());
  for (std::int32_t t = 0; t < count; ++t) {
    if (!mesh.is_alive(t)) continue;
    Cavity cavity(mesh, tags, t);
    if (cavity.worst_tet() >= least) continue;
    const double better = cavity.place_vertex(good_cavity), before = cavity.worst_tet();
    if (better < least_ratio * before || better < before + least_gain) continue;
    cavity.fill(mesh);
    ++added;
  }
  return added;
}

}  // namespace hexpipe::assemble::conform
