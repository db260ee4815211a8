// Slivers with all vertices on the boundary cannot be smoothed. A vertex goes into the space around them, as in the
// vertex insertion of B. M. Klingner, J. R. Shewchuk, "Aggressive tetrahedral mesh improvement" (2007), section 3. The
// cavity grows greedily over the worst facets (cavity.hpp) instead of by a minimum cut.

#include "tools/assemble/conform/cavity.hpp"
#include "tools/assemble/conform/flat_tets.hpp"

namespace hexpipe::assemble::conform {
namespace {

// Below this quality the cavity goes on growing.
constexpr double good_around_vertex = 0.2;
// The worst tet has to become better by this factor and by this much, more than rounding, to be worth a vertex.
constexpr double least_ratio = 1.5;
constexpr double least_gain_of_vertex = 0.005;

}  // namespace

std::int64_t split_flat_tets(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, double least) {
  std::int64_t vertices = 0;
  for (const auto t : indices<TetIndex>(mesh.tet_count())) {
    if (!mesh.is_alive(t)) continue;
    Cavity cavity(mesh, tags, t);
    if (cavity.worst_tet() >= least) continue;
    const double better = cavity.place_vertex(good_around_vertex), before = cavity.worst_tet();
    if (better < least_ratio * before || better < before + least_gain_of_vertex) continue;
    cavity.split(mesh);
    ++vertices;
  }
  return vertices;
}

}  // namespace hexpipe::assemble::conform
