#pragma once
// The relaxation of branch and cut: LP-Clique (Verhetsel 2017, 3.2) by the simplex method on an edge clique cover.
// Cliques that the fractional solution violates are added until there is none (Nemhauser and Sigismondi 1992). Unlike
// there, the prices alone prove the bounds, in whole numbers, so nothing depends on the tolerances of the simplex.

#include "common/mwis/bounds/relaxation.hpp"

namespace hexpipe::mwis::exact {

bounds::Relaxation relax_by_cutting_planes(const graph::ConflictGraph& graph, std::int64_t target, int depth,
                                           const Deadline& deadline);

}  // namespace hexpipe::mwis::exact
