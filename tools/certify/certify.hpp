#pragma once
// What a solution is worth: its weight against a proven upper bound, and the vertices that the difference decides.

#include <cstdint>
#include <functional>
#include <optional>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/bounds/clique_dual.hpp"
#include "common/mwis/exact/exact_algorithm.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::certify {

// Passes of the dual where a proof follows, whose bound is better: a third of what they are without.
inline constexpr std::int64_t passes_before_proof = 100;

struct CertifyOptions {
  mwis::bounds::CliqueDualOptions dual;
  std::optional<mwis::exact::ExactAlgorithm> exact{};  // go on to a proof of optimality
};

struct CertifyResult {
  graph::CliqueCover cover;
  mwis::bounds::CliqueDual dual;
  graph::IndependentSet solution;  // the given one, or a better one that the proof came upon
  std::int64_t weight = 0;
  // That of the dual, or a lower one that the proof brought, which has no certificate.
  std::int64_t bound = 0;
  bool maximal = false;
  // Of the bound; 0 when the solution is optimal, which `complete` says.
  double gap = 0;
  bool complete = false;
  std::int64_t nodes = 0;  // of the exact search
  // By reduced cost: vertices that no better solution has, and those that every better one has.
  std::int64_t fixed_out = 0, fixed_in = 0;
};

// Cliques that are known already, or that may be.
struct KnownCliques {
  std::optional<graph::CliqueCover> cover;    // an edge clique cover
  std::optional<graph::CliqueCover> of_tets;  // candidates that share a tet
};

// `solution` is independent. Without known cliques they are found in the graph. Those at tets, made maximal, give as
// good a bound with a third of the members: what they miss and the relaxation violates is added. Throws DataError,
// before anything else, where the graph is more than options.exact can hold.
CertifyResult certify(const graph::ConflictGraph& graph, const graph::IndependentSet& solution, KnownCliques known,
                      const CertifyOptions& options, const Deadline& deadline,
                      const std::function<void(const mwis::bounds::CliqueDual&)>& report = {});

}  // namespace hexpipe::certify
