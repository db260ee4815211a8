#pragma once
// The price of open quads, as vertices of the conflict graph: docs/definitions.md 2. A quad of a chosen candidate is
// open if it is not on the boundary and no other chosen candidate has it.
//
// Let s be the number of chosen candidates at a quad: 0, 1 or 2, because those on one side of it are in conflict. At a
// price p, the quad is worth -p if s = 1 and otherwise 0, which is p s + 2 p [s = 0] - 2 p. So each candidate weighs p
// more for the quad, and a vertex of weight 2 p, in conflict with all candidates at the quad, stands for [s = 0]. What
// is left is a plain independent set problem, less the constant 2 p: all reductions, searches and bounds hold for it.
// If no two candidates can share the quad, s is at most 1, and each candidate weighs p less instead.

#include <cstdint>
#include <vector>

#include "common/conflicts/find_conflicts.hpp"
#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::conflicts {

// Quads, ascending, and the candidates at each.
struct QuadList {
  std::vector<VertexKey<4>> quads;
  std::vector<std::int64_t> offsets{0};       // quads + 1
  std::vector<CandidateIndex> candidates_at;  // ascending within a quad

  std::size_t size() const { return quads.size(); }
};

struct InnerQuads {
  QuadList shared;  // two candidates without a conflict have it
  QuadList lonely;  // of one or more candidates that are all in conflict
};

// Vertex i of `graph` is candidate i; the candidates need no tets. `boundary` has the facets on the boundary; if it is
// empty, nobody knows which quads lie there, and none counts as lonely.
InnerQuads find_inner_quads(const Candidates& candidates, const graph::ConflictGraph& graph, const KeySet<3>& boundary);

// The facets of only one tet.
KeySet<3> boundary_of(const TetMesh& mesh, const char* source);

// The price of each quad: `share` times the mean weight that the candidates at the quad would have at a quality of 1.
// Throws DataError naming `source` when a price is too large.
std::vector<std::int64_t> prices_of(const QuadList& quads, const Candidates& candidates,
                                    const ConflictOptions& weighing, double share, const char* source);

// Appends the vertices of shared quads to those of the candidates. A solution then has quads without a chosen
// candidate, too. If it has all of these, its weight is that of its candidates, less the prices of open quads, plus
// twice the sum of all prices. Throws DataError naming `source` when the vertices are 2^31 or more, or the sum of
// weights does not fit 64 bits.
void add_quad_vertices(const QuadList& shared, const std::vector<std::int64_t>& prices, graph::ConflictGraph& graph,
                       const char* source);

// Candidates pay for their lonely quads, once they have gained for the others. None weighs less than 0: such a
// candidate is worth nothing with whatever neighbours.
void pay_for_lonely_quads(const QuadList& lonely, const std::vector<std::int64_t>& prices, graph::ConflictGraph& graph);

}  // namespace hexpipe::conflicts
