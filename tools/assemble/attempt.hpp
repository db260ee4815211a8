#pragma once
// Builds the mesh from checked cells in attempts: makes it conforming, smooths it, and if cells stay poor, tries again
// without them.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/conform/conform.hpp"
#include "tools/assemble/hybrid/extract.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/input_surface.hpp"
#include "tools/assemble/shape/smooth.hpp"
#include "tools/assemble/statistics.hpp"

namespace hexpipe::assemble {

// The tets and their surface, which stay as they are in all attempts.
struct AssembleInput {
  // The surface of the mesh is complete. The adjacency takes much memory and is not needed afterwards.
  AssembleInput(TetMesh tets, const TetAdjacency& adjacency) : mesh(std::move(tets)), surface(mesh, adjacency) {}
  AssembleInput(const AssembleInput&) = delete;
  AssembleInput& operator=(const AssembleInput&) = delete;

  const TetMesh mesh;
  const shape::InputSurface surface;
};

struct BuildRules {
  bool is_conforming = true;
  int smooth_rounds = 0;
  bool merges = false;         // makes the cells between the hexes fewer; only with is_conforming and smooth_rounds
  bool mends_refused = false;  // and then mends what checkMesh counts as wrong; only with merges
  const hybrid::Seam* seam = nullptr;  // of a piece

  // By vertex of the input, as in Seam; empty without a seam.
  std::span<const std::uint8_t> is_shared() const;
  bool is_guest(CandidateIndex candidate) const { return seam != nullptr && seam->is_guest[candidate] != 0; }
};

// Candidates that went back to their tets between attempts.
struct GivenBackCounts {
  std::array<std::int64_t, conform::all_reasons.size()> cells{};
  double hex_volume = 0;

  void add(const Candidates& candidates, const std::vector<CandidateIndex>& given_back, conform::GivenBack reason);
};

// One attempt: the mesh and what it took to make it.
struct Attempt {
  hybrid::SurfaceTags tags;  // the input's, less the tets that were peeled off
  hybrid::HybridMesh mesh;
  conform::ConformityCounts conformity{};
  ImprovementCounts improvement{};
  KindTable before_smoothing{};
  hybrid::Extract extracted{};  // of the mesh
  shape::Settled settled{};
};

// The last attempt, without the mesh under assembly: that takes much memory.
struct Built {
  hybrid::SurfaceTags tags;
  hybrid::Extract extracted;
  conform::ConformityCounts conformity;  // with the cells given back between attempts
  ImprovementCounts improvement;
  KindTable before_smoothing;
  std::vector<CandidateIndex> left;  // the candidates that are cells of the mesh, ascending
};

// Where the first attempt begins.
struct AttemptStart {
  hybrid::SurfaceTags tags;  // of the input
  choice::Selection selection;
  GivenBackCounts given_back;  // cells given back before
};

// Throws DataError, with the candidates' name, if a candidate that remains is not valid.
Built build_mesh(const AssembleInput& input, const Candidates& candidates, AttemptStart start, const BuildRules& rules,
                 const choice::InputNames& names);

}  // namespace hexpipe::assemble
