#pragma once
// Judges a solution: its weight against a proven upper bound, and the vertices that the difference decides.

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/graph/clique_cover.hpp"
#include "common/graph/conflict_graph.hpp"
#include "common/mwis/bounds/clique_dual.hpp"
#include "common/run/deadline.hpp"
#include "formats/streams/output.hpp"
#include "tools/certify/options.hpp"

namespace hexpipe::certify {

struct CertifyResult {
  graph::CliqueCover cover;
  mwis::bounds::CliqueDual dual;
  graph::IndependentSet solution;  // the given one, or a better one that the proof found
  std::int64_t weight = 0;
  std::int64_t bound = 0;  // the dual's, or a lower one that the proof found, which has no certificate
  bool maximal = false;
  double gap = 0;          // to the bound, as a share of it
  bool complete = false;   // the solution is optimal
  std::int64_t nodes = 0;  // of the exact search
  // Vertices that no better solution has, and vertices that every better solution has, both by reduced cost.
  std::int64_t fixed_out = 0, fixed_in = 0;
};

// Cliques that are known before the dual begins.
struct KnownCliques {
  std::optional<graph::CliqueCover> cover;    // an edge clique cover
  std::optional<graph::CliqueCover> of_tets;  // candidates that share a tet
};

// `solution` is independent. Without known cliques, they are found in the graph. The cliques at tets, made maximal,
// give as good a bound with a third of the members; cliques that they miss and the relaxation violates are added.
// Throws DataError, before anything else, where the graph is too large for options.exact.
CertifyResult certify(const graph::ConflictGraph& graph, const graph::IndependentSet& solution, KnownCliques known,
                      const CertifyOptions& options, const Deadline& deadline,
                      const std::function<void(const mwis::bounds::CliqueDual&)>& report = {});

nlohmann::ordered_json to_json(const CertifyResult& result);
std::string summary(const CertifyResult& result);

// Writes the proof of the dual's bound as a text that others can check: a line `bound B`, then a line for each clique
// with a price, the price and the vertices counted from 1. The bound is the sum of the prices and of what each vertex
// weighs beyond the prices of its cliques.
void write_certificate(const graph::CliqueCover& cover, const mwis::bounds::CliqueDual& dual, formats::Output& output);

}  // namespace hexpipe::certify
