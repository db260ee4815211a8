#include "formats/pipeline/stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <utility>

#include "common/mesh/orientation.hpp"
#include "common/run/error.hpp"
#include "formats/choice/cand.hpp"
#include "formats/choice/dimacs.hpp"
#include "formats/choice/metis.hpp"
#include "formats/choice/solution_file.hpp"
#include "formats/meshes/mesh_files.hpp"
#include "formats/meshes/mesh_surface.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/members.hpp"
#include "formats/pipeline/output_format.hpp"
#include "formats/pipeline/surface_bundle.hpp"

namespace hexpipe::pipeline {
namespace {

std::vector<std::string_view> product_formats(Role product) {
  switch (product) {
    case Role::candidates:
      return {"cand"};
    case Role::graph:
      return {"graph"};
    case Role::solution:
      return {"sol"};
    case Role::mesh:
    case Role::result:
      break;
  }
  return formats::mesh_format_names();
}

// The format that the command line asks for. Throws UsageError when the product cannot be written so.
std::string choose_format(const StreamOptions& streams, Role product) {
  const bool to_file = !streams.output.empty() && streams.output != "-";
  const bool to_device = streams.output.starts_with("/dev/");
  std::string_view format = streams.format;
  if (format.empty()) format = to_file && !to_device ? ending_of(streams.output) : bundle_format;
  const auto known = product_formats(product);
  if (is_bundle_format(format) || std::find(known.begin(), known.end(), format) != known.end())
    return std::string(format);
  throw UsageError(fmt::format("expected {} as {} or tar, tar.zst, found '{}'", name_of(product),
                               fmt::join(known, ", "), streams.format.empty() ? streams.output : streams.format));
}

bool is_text_format(std::string_view format) {
  return !is_bundle_format(format) && !format.ends_with("-binary") && format != "vtu";
}

// The tool whose product it is.
const char* maker_of(Role role) {
  constexpr const char* tools[] = {"tetmesh", "findhex", "buildgraph", "initsol", "assemble"};
  return tools[static_cast<int>(role)];
}

std::string list_of(const std::set<Role>& roles) {
  std::vector<std::string_view> names;
  names.reserve(roles.size());
  for (const Role role : roles) names.emplace_back(name_of(role));
  return names.empty() ? "nothing that the pipeline makes" : fmt::format("{}", fmt::join(names, ", "));
}

bool holds(const StageData& data, Role role) {
  switch (role) {
    case Role::mesh:
      return data.mesh.has_value();
    case Role::candidates:
      return data.candidates.has_value();
    case Role::graph:
      return data.graph.has_value();
    case Role::solution:
      return data.solution.has_value();
    case Role::result:
      break;
  }
  return data.result.has_value();
}

// The number of things that a solution chooses from, where it is known.
std::int64_t vertex_count_for_solution(const StageData& data, const std::string& source) {
  if (data.graph) return data.graph->vertex_count();
  if (data.candidates) return static_cast<std::int64_t>(data.candidates->size());
  throw DataError::at(source, "expected a graph or candidates beside the solution, found neither");
}

void read_role_file(Role role, formats::Input& input, StageData& data) {
  switch (role) {
    case Role::mesh:
      data.mesh = to_tet_mesh(formats::read_mixed_mesh(input, &data.names), input.name().c_str());
      break;
    case Role::candidates:
      data.candidates = formats::read_cand(input);
      break;
    case Role::graph:
      data.graph = formats::looks_like_dimacs(input) ? formats::read_dimacs(input) : formats::read_metis(input);
      break;
    case Role::solution:
      data.solution = formats::read_solution(input, vertex_count_for_solution(data, input.name()));
      break;
    case Role::result:
      data.result = formats::read_mixed_mesh(input, &data.names);
      break;
  }
}

void write_role(Role role, const StageData& data, BundleWriter& writer) {
  switch (role) {
    case Role::mesh:
      if (data.part) write_members(writer, *data.part);
      write_members(writer, *data.mesh);
      break;
    case Role::candidates:
      if (data.candidate_keys) write_members(writer, *data.candidate_keys);
      write_members(writer, *data.candidates);
      break;
    case Role::graph:
      write_members(writer, *data.graph);
      if (data.cover) write_members(writer, *data.cover);
      break;
    case Role::solution:
      write_members(writer, *data.solution);
      if (data.gaps) write_gap_members(writer, *data.gaps);
      break;
    case Role::result:
      write_members(writer, *data.result);
      break;
  }
}

struct KeysAndCandidates {
  const CandidateKeys* keys;
  const Candidates& candidates;
};

void write_members(BundleWriter& writer, const KeysAndCandidates& product) {
  if (product.keys != nullptr) write_members(writer, *product.keys);
  write_members(writer, product.candidates);
}

struct GraphAndCover {
  const graph::ConflictGraph& graph;
  const graph::CliqueCover* cover;
};

void write_members(BundleWriter& writer, const GraphAndCover& product) {
  write_members(writer, product.graph);
  if (product.cover != nullptr) write_members(writer, *product.cover);
}

struct SolutionAndGaps {
  const graph::IndependentSet& solution;
  const std::vector<std::int64_t>* gaps;
};

void write_members(BundleWriter& writer, const SolutionAndGaps& product) {
  write_members(writer, product.solution);
  if (product.gaps != nullptr) write_gap_members(writer, *product.gaps);
}

void validate_gaps(const StageData& data, const char* name) {
  const std::size_t chosen = data.solution ? data.solution->size() : 0;
  if (data.gaps->size() != chosen)
    throw DataError::at(name, "expected a gap for each of the {} chosen, found {}", chosen, data.gaps->size());
  for (const std::int64_t gap : *data.gaps)
    if (gap < 0) throw DataError::at(name, "expected gaps of at least 0, found {}", gap);
}

// Arrays that a stage of the user's own may leave out.
void fill_defaults(StageData& data) {
  if (data.mesh) {
    TetMesh& mesh = *data.mesh;
    if (mesh.tet_tags.empty()) mesh.tet_tags.resize(mesh.tets.size(), 0);
    if (mesh.triangle_tags.empty()) mesh.triangle_tags.resize(mesh.triangles.size(), 0);
  }
  if (data.result) {
    auto fill = [](auto& block) {
      if (block.tags.empty()) block.tags.resize(block.cells.size(), 0);
    };
    fill(data.result->hexes), fill(data.result->prisms), fill(data.result->pyramids), fill(data.result->tets);
    fill(data.result->triangles), fill(data.result->quads);
  }
}

}  // namespace

struct Stage::State {
  RunContext context;
  std::string format;
  std::optional<formats::Output> output;
  std::optional<BundleWriter> bundle;
  int history_count = 0;
  formats::GroupNames names;  // of the tags of the product
  bool names_are_written = false;
  // Where each role came from, for messages.
  std::map<Role, std::string> sources;
  std::set<Role> seen;
  std::vector<Role> replaced;  // those that came from files of their own beside a bundle
  bool with_cover = false, with_part = false, with_weights = false;
  std::set<Role> held_back;

  Role product() const { return *context.info.product; }
  bool reads(Role role) const {
    const auto& roles = context.info.reads;
    return std::find(roles.begin(), roles.end(), role) != roles.end();
  }

  void choose_output();
  void read_bundle(formats::Input& input, const std::set<Role>& taken, StageData& data);
  void pass_history_entry(BundleReader& reader, std::vector<nlohmann::ordered_json>& history);
  void write_names();
  void read_files(std::map<Role, formats::Input>& files, StageData& data);
  void orient(TetMesh& mesh, const std::string& name) const;
  void check(const StageData& data) const;
  std::string source_of(Role role) const;
  void write_history(const nlohmann::ordered_json& details);
  template <class Product, class WriteFile>
  void write(const Product& product, const nlohmann::ordered_json& details, WriteFile&& write_file);
};

Stage::Stage(const RunContext& context) : state_(std::make_unique<State>()) {
  state_->context = context;
  const StreamOptions& streams = context.streams;
  if (context.info.product) state_->choose_output();
  int from_stdin = streams.operand == "-" ? 1 : 0;
  for (const auto& [role, path] : streams.files) from_stdin += path == "-" ? 1 : 0;
  if (from_stdin > 1) throw UsageError("expected at most one input from standard input ('-'), found several");
}

void Stage::State::choose_output() {
  const StreamOptions& streams = context.streams;
  format = choose_format(streams, product());
  const bool to_stdout = streams.output.empty() || streams.output == "-";
  if (to_stdout && !is_text_format(format) && isatty(STDOUT_FILENO))
    throw UsageError(
        fmt::format("standard output is a terminal: pipe it to the next tool, or write a file with -o, or text "
                    "with --format {}",
                    product_formats(product()).front()));
}

Stage::~Stage() = default;

void Stage::begin() {
  if (!state_->context.info.product) return;
  state_->output.emplace(state_->context.streams.output);
  if (is_bundle_format(state_->format))
    state_->bundle.emplace(*state_->output,
                           state_->context.streams.compress || state_->format == compressed_bundle_format);
}

StageData Stage::read(const std::vector<Role>& needs, const std::vector<Role>& wants) {
  State& state = *state_;
  const StreamOptions& streams = state.context.streams;
  std::set<Role> taken(needs.begin(), needs.end());
  taken.insert(wants.begin(), wants.end());

  std::map<Role, formats::Input> files;
  for (const auto& [role, path] : streams.files) files.emplace(role, formats::Input::open(path));

  // Files may cover all that is needed; otherwise there must be an operand or a stream.
  const bool covered =
      !files.empty() && std::all_of(needs.begin(), needs.end(), [&](Role role) { return files.contains(role); });
  std::optional<formats::Input> input;
  if (streams.operand) {
    input = formats::Input::open(*streams.operand);
  } else if (!covered) {
    if (isatty(STDIN_FILENO))
      throw UsageError(fmt::format("nothing to read: name a file, or pipe a bundle to standard input (see {} --help)",
                                   state.context.info.name));
    input = formats::Input::open("-");
  }
  if (input && !looks_like_bundle(*input)) {
    if (input->peek(1).empty())
      throw DataError::at(input->name(), "expected a bundle or the {}, found nothing: it is empty",
                          name_of(state.context.info.reads.front()));
    const Role primary = state.context.info.reads.front();
    if (files.contains(primary))
      throw DataError::at(input->name(), "expected a bundle beside --{}, found another file", name_of(primary));
    files.emplace(primary, std::move(*input));
    input.reset();
  }

  begin();
  StageData data;
  if (input) {
    for (const auto& [role, file] : files) state.replaced.push_back(role);
    state.read_bundle(*input, taken, data);
  }
  state.read_files(files, data);
  state.names = data.names;
  for (const Role role : needs)
    if (!holds(data, role))
      throw DataError::at(input ? input->name() : std::string("the files"), "expected {} for {}, found {}; {} makes it",
                          name_of(role), state.context.info.name, list_of(state.seen), maker_of(role));
  fill_defaults(data);
  state.check(data);
  return data;
}

// What the tool makes anew, and what depended on the old one, does not pass.
void Stage::State::read_bundle(formats::Input& input, const std::set<Role>& taken, StageData& data) {
  BundleReader reader(input);
  const bool has_other_mesh = context.streams.files.contains(Role::mesh);
  while (reader.next()) {
    const auto role = role_of_member(reader.name());
    const bool is_replaced =
        role ? context.streams.files.contains(*role)
             : has_other_mesh && (is_surface_member(reader.name()) || reader.name() == formats::names_member);
    const bool passes = bundle && !is_replaced && (!role || (*role < product() && !held_back.contains(*role)));
    if (role && !is_replaced) {
      seen.insert(*role);
      sources[*role] = input.name();
      if (with_part && read_part_member(reader, data, passes ? &*bundle : nullptr)) continue;
      if (with_weights && read_weights(reader, data, passes ? &*bundle : nullptr)) continue;
      if (taken.contains(*role) && read_member(reader, data, passes ? &*bundle : nullptr, with_cover)) continue;
    }
    if (is_history_entry(reader.name())) {
      pass_history_entry(reader, data.history);
    } else if (reader.name() == formats::names_member && !is_replaced) {
      if (!names.empty()) throw DataError::at(reader.where(), "expected names once, found them again");
      names = data.names = formats::parse_group_names(reader.read_text(), reader.where());
      write_names();
    } else if (passes) {
      reader.copy_to(*bundle);
    }
  }
}

void Stage::State::pass_history_entry(BundleReader& reader, std::vector<nlohmann::ordered_json>& history) {
  std::string text;
  history.push_back(read_history_entry(reader, &text));
  ++history_count;
  if (bundle) bundle->add_text(reader.name(), text);
}

// Once: where they were read, or behind the product where the tool sets them.
void Stage::State::write_names() {
  if (!bundle || names.empty() || std::exchange(names_are_written, true)) return;
  bundle->add_text(std::string(formats::names_member), text_of(names));
}

// Files of other programs list tets in any sense; bundles hold them positively oriented.
void Stage::State::orient(TetMesh& mesh, const std::string& name) const {
  validate(mesh, name.c_str());
  if (const auto warning = turned_tets_warning(orient_tets(mesh, name.c_str()))) context.warn(name + ": " + *warning);
}

// In the order of the pipeline: a solution needs to know its graph.
void Stage::State::read_files(std::map<Role, formats::Input>& files, StageData& data) {
  for (auto& [role, input] : files) {
    seen.insert(role);
    sources[role] = input.name();
    if (looks_like_bundle(input)) {
      BundleReader reader(input);
      const bool has_tags = role == Role::mesh || role == Role::result;
      while (reader.next())
        if (has_tags && reader.name() == formats::names_member)
          data.names = formats::parse_group_names(reader.read_text(), reader.where());
        else if (role_of_member(reader.name()) == role && !(with_part && read_part_member(reader, data, nullptr)))
          read_member(reader, data, nullptr, with_cover || bundle);
      if (!holds(data, role))
        throw DataError::at(input.name(), "expected {} in this bundle, found none", name_of(role));
      fill_defaults(data);
    } else {
      read_role_file(role, input, data);
      if (role == Role::mesh) orient(*data.mesh, input.name());
    }
    if (bundle && role < product() && !held_back.contains(role)) {
      write_role(role, data, *bundle);
      if (role == Role::mesh) names = data.names;
      write_names();
    }
  }
}

std::string Stage::State::source_of(Role role) const {
  const auto found = sources.find(role);
  return found == sources.end() ? std::string(name_of(role)) : fmt::format("{}: {}", found->second, name_of(role));
}

formats::SurfaceSoup Stage::read_surface(formats::Input& input) {
  State& state = *state_;
  if (!looks_like_bundle(input)) {
    constexpr std::size_t enough_to_tell = 4096;
    formats::SurfaceSoup surface = formats::looks_like_mesh_surface(input.peek(enough_to_tell))
                                       ? formats::read_mesh_surface(input)
                                       : formats::read_surface(input);
    begin();
    return surface;
  }
  begin();
  std::vector<nlohmann::ordered_json> history;
  const auto pass = [&](BundleReader& reader) {
    if (is_history_entry(reader.name()))
      state.pass_history_entry(reader, history);
    else if (state.bundle && !role_of_member(reader.name()))
      reader.copy_to(*state.bundle);
  };
  return read_surface_bundle(input, pass, state.bundle ? &*state.bundle : nullptr);
}

void Stage::set_names(formats::GroupNames names) {
  state_->names = std::move(names);
}

void Stage::take_cover() {
  state_->with_cover = true;
}

void Stage::take_weights() {
  state_->with_weights = true;
}

void Stage::take_part() {
  state_->with_part = true;
}

void Stage::hold_back(Role role) {
  state_->held_back.insert(role);
}

bool Stage::writes_bundle() const {
  return is_bundle_format(state_->format);
}

std::string Stage::source_of(Role role) const {
  return state_->source_of(role);
}

void Stage::State::check(const StageData& data) const {
  if (data.mesh) validate(*data.mesh, source_of(Role::mesh).c_str());
  if (data.part) {
    validate(*data.part, source_of(Role::mesh).c_str());
    if (data.mesh) validate_against(*data.part, *data.mesh, source_of(Role::mesh).c_str());
  }
  if (data.candidates) {
    validate(*data.candidates, source_of(Role::candidates).c_str());
    if (data.mesh) validate_against(*data.candidates, *data.mesh, source_of(Role::candidates).c_str());
    if (data.part) validate_against(*data.part, *data.candidates, source_of(Role::candidates).c_str());
  }
  if (data.candidates && data.candidate_keys)
    validate(*data.candidate_keys, data.candidates->size(), source_of(Role::candidates).c_str());
  if (data.graph) {
    graph::validate(*data.graph, source_of(Role::graph).c_str());
    if (data.candidates && data.candidates->size() != data.graph->weights.size())
      throw DataError::at(source_of(Role::graph), "expected a vertex for each of the {} candidates, found {}",
                          data.candidates->size(), data.graph->weights.size());
  }
  if (data.cover) graph::validate(*data.cover, *data.graph, source_of(Role::graph).c_str());
  if (data.solution && data.graph) graph::validate(*data.solution, *data.graph, source_of(Role::solution).c_str());
  if (data.gaps) validate_gaps(data, source_of(Role::solution).c_str());
  if (data.result) validate(*data.result, source_of(Role::result).c_str());
}

void Stage::State::write_history(const nlohmann::ordered_json& details) {
  nlohmann::ordered_json entry = history_entry_of(context);
  for (const Role role : replaced) entry["replaced"].push_back(name_of(role));
  if (!details.is_null()) entry.update(details);
  write_history_entry(*bundle, history_member(history_count + 1, entry), entry);
}

template <class Product, class WriteFile>
void Stage::State::write(const Product& product, const nlohmann::ordered_json& details, WriteFile&& write_file) {
  if (bundle) {
    write_members(*bundle, product);
    write_names();
    write_history(details);
    bundle->close();
  } else {
    write_file(*output);
  }
  output->commit();
}

void Stage::write(const TetMesh& mesh, const nlohmann::ordered_json& details) {
  state_->write(mesh, details, [&](formats::Output& output) {
    formats::write_mixed_mesh(to_mixed_mesh(mesh), state_->format, output);
  });
}

void Stage::write(const Candidates& candidates, const CandidateKeys* keys, const nlohmann::ordered_json& details) {
  state_->write(KeysAndCandidates{keys, candidates}, details,
                [&](formats::Output& output) { formats::write_cand(candidates, output); });
}

void Stage::write(const graph::ConflictGraph& graph, const CandidateKeys* keys, const Candidates* candidates,
                  const graph::CliqueCover* cover, const nlohmann::ordered_json& details) {
  if (state_->bundle && candidates != nullptr) write_members(*state_->bundle, KeysAndCandidates{keys, *candidates});
  state_->write(GraphAndCover{graph, cover}, details, [&](formats::Output& output) {
    if (const auto warning = formats::metis_weight_warning(graph)) state_->context.warn(*warning);
    formats::write_metis(graph, output);
  });
}

void Stage::write(const graph::IndependentSet& solution, const nlohmann::ordered_json& details,
                  const std::vector<std::int64_t>* gaps) {
  state_->write(SolutionAndGaps{solution, gaps}, details,
                [&](formats::Output& output) { formats::write_solution(solution, output); });
}

void Stage::write(const MixedMesh& result, const MeshPiece* piece, const nlohmann::ordered_json& details) {
  if (state_->bundle && piece != nullptr) write_members(*state_->bundle, *piece);
  state_->write(result, details,
                [&](formats::Output& output) { formats::write_mixed_mesh(result, state_->format, output); });
}

}  // namespace hexpipe::pipeline
