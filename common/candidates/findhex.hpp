#pragma once
// Finds all hexes, prisms and pyramids that could be built by merging tets of a mesh: docs/definitions.md 1.

#include <array>
#include <cstdint>
#include <vector>

#include "common/candidates/cell_tets.hpp"
#include "common/candidates/mesh_tables.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/run/share.hpp"

namespace hexpipe::candidates {

enum class CandidateQuality { corner, element };

struct FindhexOptions {
  std::vector<CellKind> kinds{CellKind::hex};  // found one kind after another, in this order
  double min_quality = least_hex_quality;      // each corner has to exceed this
  CandidateQuality quality = CandidateQuality::element;
  bool drop_folded_quads = true;  // rule 8
  CellTetRules tet_rules{};
  double feature_angle = default_feature_angle;  // rule 10, in degrees
  Share share{};                                 // only cells whose corner 0 is in this share of the vertices
};

// How many cells of a kind got how far.
struct CellCounts {
  std::int64_t complete = 0;                 // rules 1 to 3 and 8 hold
  std::int64_t invalid = 0;                  // rule 4
  std::array<std::int64_t, 9> by_verdict{};  // rules 5 to 7, 9 and 10, by TetVerdict

  std::int64_t accepted() const { return by_verdict[static_cast<int>(TetVerdict::accepted)]; }
  CellCounts& operator+=(const CellCounts& other);
};

struct KindCounts {
  CellKind kind;
  CellCounts counts;
};

struct FindhexResult {
  // Sorted by kind, then by the vertex at corner 0; the same for any number of threads.
  Candidates candidates;
  std::vector<KindCounts> counts;
  MeshFindings findings;
  std::int64_t triangulated_quads = 0;
};

// Facts about a mesh that is cut out of another one, if they are known.
struct SearchScope {
  std::vector<bool> begins_at;     // vertices where cells may begin; empty: all
  std::vector<std::int8_t> turns;  // TetOrientation::turns; empty: not known yet
};

// Throws DataError naming `source` when a facet of the mesh belongs to more than two tets.
FindhexResult findhex(TetMesh mesh, const FindhexOptions& options, const char* source, const SearchScope& scope = {});

}  // namespace hexpipe::candidates
