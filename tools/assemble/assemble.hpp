#pragma once
// From a choice of candidates to the hex-dominant mesh.

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/mixed_mesh.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/hybrid/seam.hpp"
#include "tools/assemble/statistics.hpp"

namespace hexpipe::assemble {

struct AssembleOptions {
  enum class Conformity { pyramids, none };
  Conformity conformity = Conformity::pyramids;
  // Chosen hexes are exchanged for others that leave fewer quads open (exchange.hpp), where the result is to conform
  // and is no piece of a mesh.
  enum class Exchange { quads, none };
  Exchange exchange = Exchange::quads;
  // Then prisms are made of the tets between the chosen cells, in the same case.
  enum class Fill { prisms, none };
  Fill fill = Fill::prisms;
  int smooth = 5;  // rounds over all vertices
};

struct AssembleResult {
  MixedMesh mesh;  // with quality
  AssembleStatistics statistics;
  // By point the input's vertex that it was, or a number from theirs on for one that was added.
  std::vector<Vertex> origin;
  graph::IndependentSet left;  // of a piece: the chosen candidates that are cells of the mesh, ascending
};

// Throws DataError, with the mesh's name and the number of the tet from 1, when one is not positively oriented.
void check_orientation(const TetMesh& mesh, const choice::InputNames& names);

// The chosen cells, or what they are exchanged for, and the tets that remain, with the input's regions and tagged
// facets; with Conformity::pyramids conforming. The result is checked (self_check.hpp) before it is returned.
//
// Throws DataError, with the name of the input, when a tet is not positively oriented, the candidates are not of this
// mesh, or the chosen ones cannot stand together or are not valid.
//
// Of a piece of a mesh, with its `seam`, the triangles have every facet of its boundary and interfaces; the result is
// without the guests and without facets that have the tags of `seam`.
AssembleResult assemble(TetMesh mesh, const Candidates& candidates, const graph::IndependentSet& chosen,
                        const AssembleOptions& options, const choice::InputNames& names = {},
                        const hybrid::Seam* seam = nullptr);

}  // namespace hexpipe::assemble
