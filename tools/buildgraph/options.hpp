#pragma once
// The command line of buildgraph as values.

#include <string>
#include <vector>

#include "common/conflicts/find_conflicts.hpp"

namespace hexpipe::buildgraph {

struct BuildgraphOptions {
  conflicts::ConflictOptions conflicts{};
  bool reduce = false;                    // leave out dominated candidates
  bool cover = false;                     // find an edge clique cover, starting from the cliques at tets
  double quad_reward = 0;                 // the price of an open quad, in weights of a candidate of quality 1
  std::string reduced_candidates{};       // a .cand of the candidates that `reduce` leaves; empty: no such file
  std::vector<std::string> neighbours{};  // bundles of the candidates of the other parts of the mesh
};

// Throws UsageError where options exclude each other, or where a graph would be written without the candidates that its
// vertices stand for.
void check(const BuildgraphOptions& options, bool to_bundle);

}  // namespace hexpipe::buildgraph
