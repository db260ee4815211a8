#pragma once
// One stage of the pipeline as every tool runs it: takes its inputs from a bundle or from files by role, passes the
// members that it read on to its output as they come, appends its own product and a history entry.

#include <memory>
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
#include "common/run/run_context.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::pipeline {

// What a stage has read; a role that was not asked for or not there stays empty.
struct StageData {
  std::optional<TetMesh> mesh;
  std::optional<Candidates> candidates;
  std::optional<graph::ConflictGraph> graph;
  std::optional<graph::CliqueCover> cover;  // of the graph, for a stage that asked for it
  std::optional<graph::IndependentSet> solution;
  // Of the solution's vertices, what certify found of the gap to its bound at each (gap_shares.hpp).
  std::optional<std::vector<std::int64_t>> gaps;
  std::optional<MixedMesh> result;
  // Where the mesh is a part of another, for a stage that asked for it.
  std::optional<MeshPart> part;
  std::optional<CandidateKeys> candidate_keys;
  formats::GroupNames names;  // of the tags of mesh and result
  std::vector<nlohmann::ordered_json> history;
};

class Stage {
 public:
  // Judges the command line: throws UsageError when a bundle would go to a terminal, nothing is there to read, two
  // inputs are standard input, or the format is unknown for the product.
  explicit Stage(const RunContext& context);
  ~Stage();

  // Reads the roles in `needs` (an error when one is missing) and those in `wants` (taken when there), each validated,
  // and the solution against the graph. When the output is a bundle every other member passes through, except the
  // tool's own product and what depends on it. A tool without a product only reads.
  StageData read(const std::vector<Role>& needs, const std::vector<Role>& wants = {});

  // Before reading: takes the graph's clique cover too, where there is one, validated.
  void take_cover();
  // Before reading: takes no more of a bundle's graph than the weights, as a graph without edges, for the edges may be
  // most of what there is to hold. A graph from a file of its own has them.
  void take_weights();
  // Before reading: takes what a part of a mesh has beside mesh and candidates, where it is one.
  void take_part();
  // Before reading: members of this role do not pass, for the tool writes them anew with its product.
  void hold_back(Role role);
  // Whether the product goes into a bundle, where others may stand beside it.
  bool writes_bundle() const;

  // The file (or stream) that a role was read from, for messages about it.
  std::string source_of(Role role) const;

  // For tetmesh: reads a surface of any format. What else a bundle has passes, but for the stages behind. Begins the
  // output.
  formats::SurfaceSoup read_surface(formats::Input& input);
  // Before writing: names that go into the bundle, or the file, with the product.
  void set_names(formats::GroupNames names);

  // Write the product, in the form that the command line asks for, then the history entry {tool, version, options,
  // replaced, ...details}, and commit; `replaced` where roles came from files beside a bundle.
  void write(const TetMesh& mesh, const nlohmann::ordered_json& details);
  // Of a part of a mesh, with their keys in a bundle; else null.
  void write(const Candidates& candidates, const CandidateKeys* keys, const nlohmann::ordered_json& details);
  // With what belongs to it, in a bundle only: candidates that were held back and their keys, a clique cover.
  void write(const graph::ConflictGraph& graph, const CandidateKeys* keys, const Candidates* candidates,
             const graph::CliqueCover* cover, const nlohmann::ordered_json& details);
  // With the gap at its vertices in a bundle, where that is known.
  void write(const graph::IndependentSet& solution, const nlohmann::ordered_json& details,
             const std::vector<std::int64_t>* gaps = nullptr);
  // With what a piece of a result has beside it, in a bundle only; else null.
  void write(const MixedMesh& result, const MeshPiece* piece, const nlohmann::ordered_json& details);

 private:
  // Makes the output; the bundle starts empty.
  void begin();

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hexpipe::pipeline
