#pragma once
// One stage of the pipeline as every tool runs it: it reads its inputs from a bundle or from one file for each role,
// passes the members that it read on to its output as they come, and appends its own product and a history entry.

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/run/run_context.hpp"
#include "formats/pipeline/stage_data.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/streams/input.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::pipeline {

// The data that a stage asks for.
struct StageRequest {
  std::vector<Role> needs{};  // an error when one is missing
  std::vector<Role> wants{};  // taken where they are there
  bool cover = false;         // the graph's clique cover, too, where there is one
  bool shape = false;         // the CAD's faces and curves, too, where a bundle has them
  bool surface = false;       // the triangles that the mesh was made of, too, where a bundle has them
  bool dislocations = false;  // of the mesh, too, where a bundle has them
  bool part = false;          // what a part of a mesh has beside mesh and candidates, too, where it is one
  // All members of the surface, too, as they are, for a tool that makes bundles of its own.
  bool surface_members = false;
  // A bundle's graph gives its weights only, as a graph without edges: the edges may be most of what there is to hold.
  // A graph in a file of its own has them.
  bool weights_only = false;
  // The candidates' kinds and volumes, too, where they come with a bundle and are not asked for as a whole: enough to
  // tell which share of the volume a choice fills.
  bool volumes = false;
  // Members of these roles do not pass: the tool writes them again with its product, or leaves them out.
  std::vector<Role> hold_back{};
};

class Stage {
 public:
  // Judges the command line: throws UsageError when a bundle would go to a terminal, two inputs are standard input, or
  // the product has no such format.
  explicit Stage(const RunContext& context);
  ~Stage();

  // Reads what the request asks for and validates each role, the solution against the graph. When the output is a
  // bundle, every other member passes through, except the tool's own product and what depends on it. A tool without a
  // product only reads. Throws UsageError when there is nothing to read.
  StageData read(const StageRequest& request);

  // Throws UsageError if the product, of second order, is to go to a format that cannot hold it. `full`: with nodes in
  // quads and hexes.
  void expect_second_order(bool full) const;

  // The name of the format that the product is written in.
  std::string_view format() const;

  // Whether the product goes into a bundle, where others may stand beside it.
  bool writes_bundle() const;

  // The file (or stream) that a role was read from, for messages about it.
  std::string source_of(Role role) const;

  // For tetmesh: reads a surface of any format and begins the output. The bundle's other members pass, except those of
  // the stages after tetmesh.
  formats::SurfaceSoup read_surface(formats::Input& input);
  // Before writing: names that go into the bundle, or the file, with the product.
  void set_names(formats::GroupNames names);

  // Write the product, in the form that the command line asks for, then the history entry {tool, version, options,
  // replaced, ...details}, and commit. `replaced` lists roles that came from files beside a bundle.
  void write(const MeshProduct& product, const nlohmann::ordered_json& details);
  void write(const CandidatesProduct& product, const nlohmann::ordered_json& details);
  void write(const GraphProduct& product, const nlohmann::ordered_json& details);
  void write(const SolutionProduct& product, const nlohmann::ordered_json& details);
  void write(const ResultProduct& product, const nlohmann::ordered_json& details);

 private:
  // Makes the output; the bundle starts empty.
  void begin();

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hexpipe::pipeline
