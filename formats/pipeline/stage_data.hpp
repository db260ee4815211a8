#pragma once
// The input and the output of a stage of the pipeline: all roles together as they are read, and one product for each
// role as it is written.

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/graph/clique_cover.hpp"
#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/mesh_part.hpp"
#include "common/mesh/mesh_piece.hpp"
#include "common/mesh/mixed_mesh.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "formats/pipeline/exact_shape.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::pipeline {

// For each vertex of a solution, certify's share of the gap to its bound (gap_shares.hpp).
using SolutionGaps = std::vector<std::int64_t>;

// Both ends of each straight segment of the lines along which rows of points end.
using DislocationSegments = std::vector<std::array<double, 6>>;

// The corners of the quads whose vertices stand behind those of the candidates in the graph (quad_vertices.hpp).
using QuadsOfGraph = std::vector<std::array<Vertex, 4>>;

// The part of the candidates that tells how much a choice fills: a row for each candidate.
struct CandidateVolumes {
  std::vector<CellKind> kind;
  std::vector<double> volume;
};

// A member of a bundle, unread.
struct RawMember {
  std::string name, bytes;
};

// The data that a stage has read. A role that the stage did not ask for, or that is not there, stays empty.
struct StageData {
  std::optional<TetMesh> mesh;
  std::optional<Candidates> candidates;
  std::optional<graph::ConflictGraph> graph;
  std::optional<QuadsOfGraph> quads;        // where the graph has vertices of quads, also if it is not read
  std::optional<graph::CliqueCover> cover;  // with StageRequest::cover
  std::optional<graph::IndependentSet> solution;
  std::optional<SolutionGaps> gaps;
  std::optional<MixedMesh> result;
  std::optional<MeshPart> part;                 // with StageRequest::part, where the mesh is a part of another
  std::optional<CandidateKeys> candidate_keys;  // likewise
  std::optional<ExactShape> shape;              // with StageRequest::shape
  std::optional<formats::SurfaceSoup> surface;  // with StageRequest::surface
  std::vector<RawMember> surface_members;       // with StageRequest::surface_members
  DislocationSegments dislocations;             // with StageRequest::dislocations
  CandidateVolumes volumes;                     // with StageRequest::volumes; empty where they are not known
  formats::GroupNames names;                    // of the tags of mesh and result
  std::vector<nlohmann::ordered_json> history;
};

// Products. The optional members go into a bundle only; a file of one role has no place for them.

struct MeshProduct {
  TetMesh mesh;
  std::optional<DislocationSegments> dislocations{};  // of the lattice on which the points lie
};

struct CandidatesProduct {
  Candidates candidates;
  std::optional<CandidateKeys> keys{};  // of a part of a mesh
};

struct GraphProduct {
  graph::ConflictGraph graph;
  std::optional<graph::CliqueCover> cover{};
  std::optional<CandidatesProduct> candidates{};  // in place of those that the stage held back
  std::optional<QuadsOfGraph> quads{};
};

struct SolutionProduct {
  graph::IndependentSet solution;
  std::optional<SolutionGaps> gaps{};
};

struct ResultProduct {
  MixedMesh mesh;
  std::optional<MeshPiece> piece{};  // of a part of a mesh
};

}  // namespace hexpipe::pipeline
