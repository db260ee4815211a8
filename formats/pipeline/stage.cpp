#include "formats/pipeline/stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "common/mesh/orientation.hpp"
#include "common/run/error.hpp"
#include "formats/choice/cand.hpp"
#include "formats/choice/graph_reading.hpp"
#include "formats/choice/metis.hpp"
#include "formats/choice/solution_file.hpp"
#include "formats/meshes/mesh_files.hpp"
#include "formats/meshes/mesh_surface.hpp"
#include "formats/meshes/solvers.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/members.hpp"
#include "formats/pipeline/quads_of_choice.hpp"
#include "formats/pipeline/surface_bundle.hpp"
#include "formats/surfaces/surface_files.hpp"

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
  std::vector<std::string_view> names = formats::mesh_format_names();
  names.push_back(formats::poly_mesh_format);
  return names;
}

// "case/constant/polyMesh/" to "polyMesh".
std::string_view last_of_path(std::string_view path) {
  while (path.size() > 1 && path.ends_with('/')) path.remove_suffix(1);
  return path.substr(path.rfind('/') + 1);
}

// The format that the command line asks for. Throws UsageError when the product cannot be written so.
std::string choose_format(const StreamOptions& streams, Role product) {
  const bool to_file = !streams.output.empty() && streams.output != "-";
  const bool to_device = streams.output.starts_with("/dev/");
  std::string_view format = streams.format;
  const bool is_poly_mesh = last_of_path(streams.output) == formats::poly_mesh_format;
  if (format.empty() && is_poly_mesh) format = formats::poly_mesh_format;
  if (format.empty()) format = to_file && !to_device ? ending_of(streams.output) : bundle_format;
  if (format == formats::poly_mesh_format && (!to_file || to_device))
    throw UsageError("polyMesh is a folder of files: name it with -o");
  const auto known = product_formats(product);
  if (is_bundle_format(format) || std::find(known.begin(), known.end(), format) != known.end())
    return std::string(format);
  throw UsageError(fmt::format("expected {} as {} or tar, tar.zst, found '{}'", name_of(product),
                               fmt::join(known, ", "), streams.format.empty() ? streams.output : streams.format));
}

bool is_text_format(std::string_view format) {
  constexpr std::array<std::string_view, 5> binary{"vtu", "exo", "e", "med", "cgns"};
  return !is_bundle_format(format) && !format.ends_with("-binary") && std::ranges::find(binary, format) == binary.end();
}

// The tool that makes this product.
const char* maker_of(Role role) {
  constexpr const char* tools[] = {"tetmesh", "findhex", "buildgraph", "initsol", "assemble"};
  return tools[static_cast<int>(role)];
}

bool contains(const std::vector<Role>& roles, Role role) {
  return std::ranges::find(roles, role) != roles.end();
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
  if (data.candidates) return static_cast<std::int64_t>(data.candidates->size()) + quad_count(data);
  throw DataError::at(source, "expected a graph or candidates beside the solution, found neither");
}

graph::ConflictGraph read_graph_file(formats::Input& input, const RunContext& context) {
  const GraphFileOptions& options = context.streams.graph_file;
  formats::GraphReading reading{.format = {},
                                .weight_scale = options.weight_scale,
                                .tolerant = options.tolerant,
                                .complement = options.complement};
  if (!options.format.empty()) reading.format = formats::graph_formats().at(options.format);
  formats::LeftOut left_out;
  graph::ConflictGraph graph = formats::read_graph(input, reading, &left_out);
  if (left_out.loops + left_out.repeated > 0)
    context.warn(
        fmt::format("{}: left out {} loops and {} repeated edges", input.name(), left_out.loops, left_out.repeated));
  return graph;
}

MixedMesh read_mesh_file(formats::Input& input, const RunContext& context, formats::GroupNames& names) {
  std::vector<std::string> warnings;
  MixedMesh mesh = formats::read_mixed_mesh(input, &names, &warnings);
  for (const std::string& warning : warnings) context.warn(warning);
  return mesh;
}

void read_role_file(Role role, formats::Input& input, const RunContext& context, StageData& data) {
  switch (role) {
    case Role::mesh:
      data.mesh = to_tet_mesh(read_mesh_file(input, context, data.names), input.name().c_str());
      break;
    case Role::candidates:
      data.candidates = formats::read_cand(input);
      break;
    case Role::graph:
      data.graph = read_graph_file(input, context);
      break;
    case Role::solution:
      data.solution = formats::read_solution(input, vertex_count_for_solution(data, input.name()));
      break;
    case Role::result:
      data.result = read_mesh_file(input, context, data.names);
      break;
  }
}

// `slim`: without the conflicts of a graph.
void write_role(Role role, const StageData& data, BundleWriter& writer, bool slim) {
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
      if (slim)
        write_weights(writer, *data.graph);
      else
        write_members(writer, *data.graph);
      if (data.quads) write_quads(writer, *data.quads);
      if (data.cover && !slim) write_members(writer, *data.cover);
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

void write_members(BundleWriter& writer, const MeshProduct& product) {
  write_members(writer, product.mesh);
  if (product.dislocations) write_dislocations(writer, *product.dislocations);
}

void write_members(BundleWriter& writer, const CandidatesProduct& product) {
  if (product.keys) write_members(writer, *product.keys);
  write_members(writer, product.candidates);
}

void write_members(BundleWriter& writer, const GraphProduct& product) {
  if (product.candidates) write_members(writer, *product.candidates);
  write_members(writer, product.graph);
  if (product.quads) write_quads(writer, *product.quads);
  if (product.cover) write_members(writer, *product.cover);
}

void write_members(BundleWriter& writer, const SolutionProduct& product) {
  write_members(writer, product.solution);
  if (product.gaps) write_gap_members(writer, *product.gaps);
}

void write_members(BundleWriter& writer, const ResultProduct& product) {
  if (product.piece) write_members(writer, *product.piece);
  write_members(writer, product.mesh);
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
  formats::MeshWriting writing;
  std::optional<formats::Output> output;
  std::unique_ptr<formats::OutputFolder> folder;  // in place of `output`
  std::optional<BundleWriter> bundle;
  int history_count = 0;
  formats::GroupNames names;  // of the tags of the product
  bool names_are_written = false;
  // Where each role came from, for messages.
  std::map<Role, std::string> sources;
  std::set<Role> seen;
  std::vector<Role> replaced;  // roles that came from files beside a bundle
  bool read_graph = false;     // from a file
  StageRequest request;

  Role product() const { return *context.info.product; }
  void choose_output();
  bool takes(Role role) const { return contains(request.needs, role) || contains(request.wants, role); }
  // Whether members of this role go on to the output: the tool makes its own product again, and everything that
  // depended on the old one is void.
  bool passes(Role role) const { return bundle && role < product() && !contains(request.hold_back, role); }

  std::optional<formats::Input> open_inputs(std::map<Role, formats::Input>& files) const;
  void read_bundle(formats::Input& input, StageData& data);
  bool read_shape(BundleReader& reader, StageData& data, BundleWriter* copy);
  bool read_surface(BundleReader& reader, StageData& data, BundleWriter* copy) const;
  void take_corners(StageData& data) const;
  void pass_history_entry(BundleReader& reader, std::vector<nlohmann::ordered_json>& history);
  void write_names();
  void read_files(std::map<Role, formats::Input>& files, StageData& data);
  void orient(TetMesh& mesh, const std::string& name) const;
  void check(const StageData& data) const;
  std::string source_of(Role role) const;
  void write_history(const nlohmann::ordered_json& details);
  void write_mesh_to_folder(const MixedMesh& mesh);
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
  if (product() == Role::mesh || product() == Role::result) {
    writing = formats::mesh_writing(streams.mesh, format);
    writing.tell = [this](const std::string& line) { context.warn(line); };
    if (const std::string summary = formats::solver_summary(streams.mesh, writing); !summary.empty())
      context.note(summary);
  }
  if (streams.slim && !is_bundle_format(format))
    throw UsageError(fmt::format("--slim leaves members out of a bundle, and '{}' is none", format));
  if (to_stdout && !is_text_format(format) && isatty(STDOUT_FILENO))
    throw UsageError(
        fmt::format("standard output is a terminal: pipe it to the next tool, or write a file with -o, or text "
                    "with --format {}",
                    product_formats(product()).front()));
}

Stage::~Stage() = default;

void Stage::begin() {
  if (!state_->context.info.product) return;
  if (state_->format == formats::poly_mesh_format) {
    state_->folder = formats::open_mesh_folder(state_->context.streams.output);
    return;
  }
  state_->output.emplace(state_->context.streams.output);
  if (is_bundle_format(state_->format))
    state_->bundle.emplace(*state_->output,
                           state_->context.streams.compress || state_->format == compressed_bundle_format);
}

// The bundle that is read, if any, and the files of single roles. Files may cover all that is needed; otherwise there
// must be an operand or a stream.
std::optional<formats::Input> Stage::State::open_inputs(std::map<Role, formats::Input>& files) const {
  for (const auto& [role, path] : context.streams.files) files.emplace(role, formats::Input::open(path));
  const bool covered =
      !files.empty() && std::ranges::all_of(request.needs, [&](Role role) { return files.contains(role); });
  if (!context.streams.operand && covered) return std::nullopt;
  if (!context.streams.operand && isatty(STDIN_FILENO))
    throw UsageError(fmt::format("nothing to read: name a file, or pipe a bundle to standard input (see {} --help)",
                                 context.info.name));
  formats::Input input = formats::Input::open(context.streams.operand.value_or("-"));
  if (looks_like_bundle(input)) return input;
  const Role primary = context.info.reads.front();
  if (input.peek(1).empty())
    throw DataError::at(input.name(), "expected a bundle or the {}, found nothing: it is empty", name_of(primary));
  if (files.contains(primary))
    throw DataError::at(input.name(), "expected a bundle beside --{}, found another file", name_of(primary));
  files.emplace(primary, std::move(input));
  return std::nullopt;
}

StageData Stage::read(const StageRequest& request) {
  State& state = *state_;
  state.request = request;
  std::map<Role, formats::Input> files;
  std::optional<formats::Input> input = state.open_inputs(files);
  begin();
  StageData data;
  if (input) {
    for (const auto& [role, file] : files) state.replaced.push_back(role);
    state.read_bundle(*input, data);
  }
  state.read_files(files, data);
  state.names = data.names;
  if (data.surface) {
    data.surface->name = input->name();
    data.surface = checked_surface(*std::move(data.surface));
  }
  if (state.context.streams.graph_file.any() && !state.read_graph)
    throw UsageError("--graph-format, --weight-scale, --complement and --tolerant do nothing without a graph file");
  for (const Role role : request.needs)
    if (!holds(data, role))
      throw DataError::at(input ? input->name() : std::string("the files"), "expected {} for {}, found {}; {} makes it",
                          name_of(role), state.context.info.name, list_of(state.seen), maker_of(role));
  if (data.graph && data.graph->offsets.size() <= 1 && !data.graph->weights.empty() &&
      contains(request.needs, Role::graph))
    throw DataError::at(
        state.source_of(Role::graph),
        "expected conflicts for {}, found weights alone: the tool that wrote this left them out (--slim)",
        state.context.info.name);
  fill_defaults(data);
  state.check(data);
  state.take_corners(data);
  return data;
}

void Stage::State::read_bundle(formats::Input& input, StageData& data) {
  BundleReader reader(input);
  const bool has_other_mesh = context.streams.files.contains(Role::mesh);
  while (reader.next()) {
    const auto role = role_of_member(reader.name());
    const bool is_replaced =
        role ? context.streams.files.contains(*role)
             : has_other_mesh && (is_surface_member(reader.name()) || reader.name() == formats::names_member);
    const bool is_left_out = context.streams.slim && is_member_of_conflicts(reader.name());
    BundleWriter* const copy = bundle && !is_replaced && !is_left_out && (!role || passes(*role)) ? &*bundle : nullptr;
    if (role && !is_replaced) {
      seen.insert(*role);
      sources[*role] = input.name();
      if (request.part && read_part_member(reader, data, copy)) continue;
      if (read_quads(reader, data, copy)) continue;
      if (request.weights_only && read_weights(reader, data, copy)) continue;
      if (request.volumes && !takes(*role) && read_volumes(reader, data, copy)) continue;
      if (request.dislocations && read_dislocations(reader, data, copy)) continue;
      if (takes(*role) && read_member(reader, data, copy, request.cover)) continue;
    }
    if (request.surface_members && !is_replaced && is_surface_member(reader.name())) {
      data.surface_members.push_back({reader.name(), reader.read_bytes_as_they_come()});
      continue;
    }
    if (request.shape && read_shape(reader, data, copy)) continue;
    if (request.surface && !is_replaced && read_surface(reader, data, copy)) continue;
    if (is_history_entry(reader.name())) {
      pass_history_entry(reader, data.history);
    } else if (reader.name() == formats::names_member && !is_replaced) {
      if (!names.empty()) throw DataError::at(reader.where(), "expected names once, found them again");
      names = data.names = formats::parse_group_names(reader.read_text(), reader.where());
      write_names();
    } else if (copy) {
      reader.copy_to(*copy);
    }
  }
}

bool Stage::State::read_shape(BundleReader& reader, StageData& data, BundleWriter* copy) {
  ExactShape shape = data.shape.value_or(ExactShape{});
  if (!is_surface_member(reader.name()) || !read_shape_member(reader, shape, copy)) return false;
  data.shape = std::move(shape);
  return true;
}

bool Stage::State::read_surface(BundleReader& reader, StageData& data, BundleWriter* copy) const {
  if (!is_surface_member(reader.name())) return false;
  formats::SurfaceSoup surface = std::move(data.surface).value_or(formats::SurfaceSoup{});
  const bool known = read_surface_member(reader, surface, copy);
  if (known || data.surface) data.surface = std::move(surface);
  return known;
}

// No stage reads nodes of second order: they get the mesh of the corners.
void Stage::State::take_corners(StageData& data) const {
  if (!data.result || !data.result->second_order) return;
  context.warn(source_of(Role::result) + ": it is of second order; " + std::string(context.info.name) +
               " takes the corners alone, with straight edges");
  drop_second_order(*data.result);
}

void Stage::State::pass_history_entry(BundleReader& reader, std::vector<nlohmann::ordered_json>& history) {
  std::string text;
  history.push_back(read_history_entry(reader, &text));
  ++history_count;
  if (bundle) bundle->add_text(reader.name(), text);
}

// Writes the names once: where they were read, or after the product if the tool sets them.
void Stage::State::write_names() {
  if (!bundle || names.empty() || std::exchange(names_are_written, true)) return;
  bundle->add_text(std::string(formats::names_member), text_of(names));
}

// Files of other programs list tets in any sense; bundles hold them positively oriented.
void Stage::State::orient(TetMesh& mesh, const std::string& name) const {
  validate(mesh, name.c_str());
  if (const auto warning = turned_tets_warning(orient_tets(mesh, name.c_str()))) context.warn(name + ": " + *warning);
}

// Reads in the order of the pipeline, because a solution needs to know its graph.
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
        else if (role_of_member(reader.name()) == role && !(role == Role::graph && read_quads(reader, data, nullptr)) &&
                 !(request.part && read_part_member(reader, data, nullptr)) &&
                 !(request.dislocations && read_dislocations(reader, data, nullptr)))
          read_member(reader, data, nullptr, request.cover || bundle);
      if (!holds(data, role))
        throw DataError::at(input.name(), "expected {} in this bundle, found none", name_of(role));
      fill_defaults(data);
    } else {
      read_role_file(role, input, context, data);
      read_graph = read_graph || role == Role::graph;
      if (role == Role::mesh) orient(*data.mesh, input.name());
    }
    if (passes(role)) {
      write_role(role, data, *bundle, context.streams.slim);
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
    formats::SurfaceSoup surface = formats::looks_like_mesh_surface(input.peek(formats::bytes_that_tell_mesh))
                                       ? formats::read_mesh_surface(input)
                                       : formats::read_surface(input);
    for (const std::string& warning : surface.warnings) state.context.warn(warning);
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

void Stage::expect_second_order(bool full) const {
  if (!writes_bundle()) formats::expect_second_order(state_->context.streams.mesh, state_->format, full);
}

std::string_view Stage::format() const {
  return state_->format;
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
    const std::size_t vertices = data.graph->weights.size();
    const auto quads = static_cast<std::size_t>(quad_count(data));
    if (quads > vertices)
      throw DataError::at(source_of(Role::graph), "expected a vertex for each of the {} quads, found {}", quads,
                          vertices);
    if (data.candidates && data.candidates->size() + quads != vertices)
      throw DataError::at(source_of(Role::graph), "expected a vertex for each of the {} candidates{}, found {}",
                          data.candidates->size(), quads > 0 ? fmt::format(" and {} quads", quads) : "", vertices);
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

void Stage::State::write_mesh_to_folder(const MixedMesh& mesh) {
  writing.names = names;
  formats::write_mesh_folder(mesh, *folder, writing);
  folder->commit();
}

void Stage::write(const MeshProduct& product, const nlohmann::ordered_json& details) {
  if (state_->folder) return state_->write_mesh_to_folder(to_mixed_mesh(product.mesh));
  state_->writing.names = state_->names;
  state_->write(product, details, [&](formats::Output& output) {
    formats::write_mixed_mesh(to_mixed_mesh(product.mesh), state_->format, output, state_->writing);
  });
}

void Stage::write(const CandidatesProduct& product, const nlohmann::ordered_json& details) {
  state_->write(product, details, [&](formats::Output& output) { formats::write_cand(product.candidates, output); });
}

void Stage::write(const GraphProduct& product, const nlohmann::ordered_json& details) {
  state_->write(product, details, [&](formats::Output& output) {
    if (const auto warning = formats::metis_weight_warning(product.graph)) state_->context.warn(*warning);
    formats::write_metis(product.graph, output);
  });
}

void Stage::write(const SolutionProduct& product, const nlohmann::ordered_json& details) {
  state_->write(product, details, [&](formats::Output& output) { formats::write_solution(product.solution, output); });
}

void Stage::write(const ResultProduct& product, const nlohmann::ordered_json& details) {
  if (state_->folder) return state_->write_mesh_to_folder(product.mesh);
  state_->writing.names = state_->names;
  state_->write(product, details, [&](formats::Output& output) {
    formats::write_mixed_mesh(product.mesh, state_->format, output, state_->writing);
  });
}

}  // namespace hexpipe::pipeline
