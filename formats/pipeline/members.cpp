#include "formats/pipeline/members.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <type_traits>

#include "common/run/error.hpp"

namespace hexpipe::pipeline {
namespace {

constexpr const char* part_json = "mesh/part.json";
constexpr const char* mesh_ridges = "mesh/ridges.npy";
constexpr const char* mesh_dislocations = "mesh/dislocations.npy";
constexpr const char* graph_weights = "graph/weights.npy";
constexpr const char* graph_quads = "graph/quads.npy";
constexpr const char* candidate_kinds = "candidates/kind.npy";
constexpr const char* candidate_volumes = "candidates/volume.npy";
constexpr const char* piece_json = "result/piece.json";
constexpr std::size_t longest_part_json = 1 << 20;

// Each list names the members of a role once, for reading and writing: visit(member name, array).

template <class Mesh, class Visit>
void visit_members_of_mesh(Mesh& mesh, Visit&& visit) {
  visit("mesh/points.npy", mesh.points);
  visit("mesh/tets.npy", mesh.tets);
  visit("mesh/tet_tags.npy", mesh.tet_tags);
  visit("mesh/triangles.npy", mesh.triangles);
  visit("mesh/triangle_tags.npy", mesh.triangle_tags);
}

template <class Part, class Visit>
void visit_members_of_part(Part& part, Visit&& visit) {
  visit("mesh/point_number.npy", part.point_number);
  visit("mesh/point_part.npy", part.point_part);
  visit("mesh/tet_number.npy", part.tet_number);
  visit("mesh/tet_part.npy", part.tet_part);
  visit("mesh/triangle_number.npy", part.triangle_number);
  visit("mesh/tet_turned.npy", part.tet_turned);
}

template <class Piece, class Visit>
void visit_members_of_piece(Piece& piece, Visit&& visit) {
  visit("result/moved_tets.npy", piece.moved_tets);
  visit("result/moved_to.npy", piece.moved_to);
  visit("result/given_back.npy", piece.given_back);
  visit("result/point_number.npy", piece.point_number);
}

template <class Keys, class Visit>
void visit_members_of_keys(Keys& keys, Visit&& visit) {
  visit("candidates/key.npy", keys.key);
  visit("candidates/part.npy", keys.part);
}

template <class Cells, class Visit>
void visit_members_of_candidates(Cells& candidates, Visit&& visit) {
  visit("candidates/vertices.npy", candidates.vertices);
  visit(candidate_kinds, candidates.kind);
  visit("candidates/quality.npy", candidates.quality);
  visit(candidate_volumes, candidates.volume);
  visit("candidates/tet_offsets.npy", candidates.tet_offsets);
  visit("candidates/tets.npy", candidates.tets);
  visit("candidates/boundary_tet_offsets.npy", candidates.boundary_tet_offsets);
  visit("candidates/boundary_tets.npy", candidates.boundary_tets);
}

template <class Graph, class Visit>
void visit_members_of_graph(Graph& graph, Visit&& visit) {
  visit("graph/offsets.npy", graph.offsets);
  visit("graph/neighbours.npy", graph.neighbours);
  visit(graph_weights, graph.weights);
}

template <class Cover, class Visit>
void visit_members_of_cover(Cover& cover, Visit&& visit) {
  visit("graph/clique_offsets.npy", cover.offsets);
  visit("graph/clique_members.npy", cover.members);
}

template <class Set, class Visit>
void visit_members_of_solution(Set& solution, Visit&& visit) {
  visit("solution/chosen.npy", solution);
}

template <class Gaps, class Visit>
void visit_members_of_gaps(Gaps& gaps, Visit&& visit) {
  visit("solution/gaps.npy", gaps);
}

// The elements of a result: visit(member name, VTK's code, block).
template <class Mesh, class Visit>
void visit_elements_of_result(Mesh& mesh, Visit&& visit) {
  visit("result/hexes.npy", static_cast<std::uint8_t>(CellKind::hex), mesh.hexes);
  visit("result/prisms.npy", static_cast<std::uint8_t>(CellKind::prism), mesh.prisms);
  visit("result/pyramids.npy", static_cast<std::uint8_t>(CellKind::pyramid), mesh.pyramids);
  visit("result/tets.npy", static_cast<std::uint8_t>(CellKind::tet), mesh.tets);
  visit("result/triangles.npy", vtk_code_of_triangle, mesh.triangles);
  visit("result/quads.npy", vtk_code_of_quad, mesh.quads);
}

// The other members of a result.
template <class Mesh, class Visit>
void visit_members_of_result(Mesh& mesh, Visit&& visit) {
  visit("result/points.npy", mesh.points);
  auto cells = [&](const char* tags, const char* quality, auto& block) {
    visit(tags, block.tags);
    visit(quality, block.quality);
  };
  cells("result/hexes_tags.npy", "result/hexes_quality.npy", mesh.hexes);
  cells("result/prisms_tags.npy", "result/prisms_quality.npy", mesh.prisms);
  cells("result/pyramids_tags.npy", "result/pyramids_quality.npy", mesh.pyramids);
  cells("result/tets_tags.npy", "result/tets_quality.npy", mesh.tets);
  visit("result/triangles_tags.npy", mesh.triangles.tags);
  visit("result/quads_tags.npy", mesh.quads.tags);
}

template <class T>
T& ensure(std::optional<T>& slot) {
  if (!slot) slot.emplace();
  return *slot;
}

nlohmann::ordered_json json_of(const MeshFingerprint& whole) {
  return {{"points", whole.points},
          {"tets", whole.tets},
          {"triangles", whole.triangles},
          {"checksum", fmt::format("{:016x}", whole.checksum)}};
}

std::string text_of(const MeshPart& part) {
  const nlohmann::ordered_json json{
      {"part", part.part}, {"parts", part.parts}, {"neighbours", part.neighbours}, {"mesh", json_of(part.whole)}};
  return json.dump() + "\n";
}

std::string text_of(const MeshPiece& piece) {
  const nlohmann::ordered_json json{
      {"part", piece.part}, {"parts", piece.parts}, {"settled", piece.settled}, {"mesh", json_of(piece.whole)}};
  return json.dump() + "\n";
}

// These throw what nlohmann throws at a missing or wrong value.

MeshFingerprint fingerprint_from(const nlohmann::json& json) {
  MeshFingerprint whole{json.at("points").get<std::int64_t>(), json.at("tets").get<std::int64_t>(),
                        json.at("triangles").get<std::int64_t>(), 0};
  const auto checksum = json.at("checksum").get<std::string>();
  std::from_chars(checksum.data(), checksum.data() + checksum.size(), whole.checksum, 16);
  return whole;
}

void parse_part(const std::string& text, MeshPart& part) {
  const auto json = nlohmann::json::parse(text);
  part.part = json.at("part").get<std::int32_t>();
  part.parts = json.at("parts").get<std::int32_t>();
  part.neighbours = json.at("neighbours").get<std::vector<std::int32_t>>();
  part.whole = fingerprint_from(json.at("mesh"));
}

void parse_piece(const std::string& text, MeshPiece& piece) {
  const auto json = nlohmann::json::parse(text);
  piece.part = json.at("part").get<std::int32_t>();
  piece.parts = json.at("parts").get<std::int32_t>();
  piece.settled = json.at("settled").get<bool>();
  piece.whole = fingerprint_from(json.at("mesh"));
}

}  // namespace

std::optional<Role> role_of_member(std::string_view name) {
  const std::string_view folder = name.substr(0, name.find('/'));
  for (const Role role : all_roles)
    if (folder == name_of(role) && folder.size() < name.size()) return role;
  return std::nullopt;
}

namespace {

// Takes the elements of the block apart: corners, and what nodes of second order they have.
template <int Corners>
void take_elements(const std::vector<std::int32_t>& numbers, std::size_t columns, std::uint8_t vtk, MixedMesh& mesh,
                   CellBlock<Corners>& block) {
  const std::size_t count = numbers.size() / columns, nodes = columns - Corners;
  block.cells.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(i * columns), Corners, block.cells[i].begin());
  if (nodes == 0) return;
  if (!mesh.second_order) mesh.second_order.emplace().first = std::numeric_limits<Vertex>::max();
  SecondOrder& order = *mesh.second_order;
  order.full = order.full || nodes != node_places_of(vtk).count(false);
  std::vector<Vertex>& list = order.of_kind(vtk);
  list.clear();
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = i * columns + Corners; k < (i + 1) * columns; ++k) {
      list.push_back(numbers[k]);
      order.first = std::min(order.first, numbers[k]);
    }
}

bool read_elements(BundleReader& reader, MixedMesh& mesh, BundleWriter* copy) {
  bool known = false;
  visit_elements_of_result(mesh, [&]<int Corners>(std::string_view name, std::uint8_t vtk, CellBlock<Corners>& block) {
    if (reader.name() != name) return;
    known = true;
    const NodePlaces places = node_places_of(vtk);
    const std::array<std::uint64_t, 3> widths{Corners, Corners + places.count(false), Corners + places.count(true)};
    const auto [numbers, columns] = reader.read_rows_of(widths);
    if (copy) copy->add_rows(reader.name(), numbers, columns);
    take_elements(numbers, columns, vtk, mesh, block);
  });
  return known;
}

void write_elements(BundleWriter& writer, const MixedMesh& mesh) {
  visit_elements_of_result(mesh, [&](const char* name, std::uint8_t vtk, const auto& block) {
    if (!mesh.second_order) return writer.add_array(name, block.cells);
    std::vector<std::int32_t> numbers;
    for (std::size_t i = 0; i < block.size(); ++i) {
      numbers.insert(numbers.end(), block.cells[i].begin(), block.cells[i].end());
      const auto nodes = mesh.second_order->of(vtk, i);
      numbers.insert(numbers.end(), nodes.begin(), nodes.end());
    }
    using Row = typename std::remove_cvref_t<decltype(block.cells)>::value_type;
    writer.add_rows(name, numbers, std::tuple_size_v<Row> + node_places_of(vtk).count(mesh.second_order->full));
  });
}

}  // namespace

bool read_member(BundleReader& reader, StageData& data, BundleWriter* copy, bool with_cover) {
  bool known = false;
  auto take = [&]<class T>(std::string_view name, std::vector<T>& array) {
    if (known || reader.name() != name) return;
    known = true;
    array = reader.read_array<T>();
    if (copy) copy->add_array(reader.name(), array);
  };
  const auto role = role_of_member(reader.name());
  if (!role) return false;
  switch (*role) {
    case Role::mesh:
      visit_members_of_mesh(ensure(data.mesh), take);
      if (reader.name() == mesh_ridges) take(mesh_ridges, ensure(data.mesh->ridges));
      break;
    case Role::candidates:
      visit_members_of_candidates(ensure(data.candidates), take);
      break;
    case Role::graph:
      visit_members_of_graph(ensure(data.graph), take);
      if (with_cover && reader.name().starts_with("graph/clique_")) visit_members_of_cover(ensure(data.cover), take);
      break;
    case Role::solution:
      visit_members_of_solution(ensure(data.solution), take);
      if (reader.name() == "solution/gaps.npy") visit_members_of_gaps(ensure(data.gaps), take);
      break;
    case Role::result:
      known = read_elements(reader, ensure(data.result), copy);
      visit_members_of_result(*data.result, take);
      break;
  }
  return known;
}

bool is_member_of_conflicts(std::string_view name) {
  return name.starts_with("graph/") && name != graph_weights && name != graph_quads;
}

bool read_weights(BundleReader& reader, StageData& data, BundleWriter* copy) {
  if (reader.name() != graph_weights) return false;
  graph::ConflictGraph& graph = ensure(data.graph);
  graph.weights = reader.read_array<std::int64_t>();
  graph.offsets.assign(graph.weights.size() + 1, 0);
  if (copy) copy->add_array(graph_weights, graph.weights);
  return true;
}

bool read_quads(BundleReader& reader, StageData& data, BundleWriter* copy) {
  if (reader.name() != graph_quads) return false;
  data.quads = reader.read_array<QuadsOfGraph::value_type>();
  if (copy) copy->add_array(graph_quads, *data.quads);
  return true;
}

bool read_volumes(BundleReader& reader, StageData& data, BundleWriter* copy) {
  const auto take = [&](auto& array) {
    using Row = typename std::remove_cvref_t<decltype(array)>::value_type;
    array = reader.read_array<Row>();
    if (copy) copy->add_array(reader.name(), array);
    return true;
  };
  if (reader.name() == candidate_kinds) return take(data.volumes.kind);
  return reader.name() == candidate_volumes && take(data.volumes.volume);
}

bool read_dislocations(BundleReader& reader, StageData& data, BundleWriter* copy) {
  if (reader.name() != mesh_dislocations) return false;
  data.dislocations = reader.read_array<std::array<double, 6>>();
  for (const auto& segment : data.dislocations)
    for (const double place : segment)
      if (!std::isfinite(place)) throw DataError::at(reader.where(), "expected finite coordinates, found {}", place);
  if (copy) copy->add_array(mesh_dislocations, data.dislocations);
  return true;
}

bool is_part_title(std::string_view name) {
  return name == part_json;
}

namespace {

// Parses the member that says which part or piece of which mesh this is; `parse` throws the exceptions of nlohmann.
template <class Parse>
void parse_title(const BundleReader& reader, const char* of, Parse&& parse) {
  try {
    parse();
  } catch (const nlohmann::json::exception&) {
    throw DataError::at(reader.where(), "expected the numbers of a {} and its mesh, found something else", of);
  }
}

}  // namespace

bool read_part_member(BundleReader& reader, StageData& data, BundleWriter* copy) {
  if (is_part_title(reader.name())) {
    const std::string text = reader.read_text(longest_part_json);
    parse_title(reader, "part", [&] { parse_part(text, ensure(data.part)); });
    if (copy) copy->add_text(reader.name(), text);
    return true;
  }
  bool known = false;
  auto take = [&]<class T>(std::string_view name, std::vector<T>& array) {
    if (known || reader.name() != name) return;
    known = true;
    if (!data.part) throw DataError::at(reader.where(), "expected {} before it, found none", part_json);
    array = reader.read_array<T>();
    if (copy) copy->add_array(reader.name(), array);
  };
  if (reader.name().starts_with("mesh/")) {
    MeshPart none;
    visit_members_of_part(data.part ? *data.part : none, take);
  } else if (reader.name().starts_with("candidates/")) {
    CandidateKeys keys = std::move(data.candidate_keys).value_or(CandidateKeys());
    visit_members_of_keys(keys, take);
    if (known || data.candidate_keys) data.candidate_keys = std::move(keys);
  }
  return known;
}

bool is_piece_title(std::string_view name) {
  return name == piece_json;
}

bool read_piece_member(BundleReader& reader, std::optional<MeshPiece>& piece) {
  if (is_piece_title(reader.name())) {
    parse_title(reader, "piece", [&] { parse_piece(reader.read_text(longest_part_json), ensure(piece)); });
    return true;
  }
  bool known = false;
  MeshPiece none;
  visit_members_of_piece(piece ? *piece : none, [&]<class T>(std::string_view name, std::vector<T>& array) {
    if (known || reader.name() != name) return;
    known = true;
    if (!piece) throw DataError::at(reader.where(), "expected {} before it, found none", piece_json);
    array = reader.read_array<T>();
  });
  return known;
}

namespace {

auto writing_to(BundleWriter& writer) {
  return [&writer](const char* name, const auto& array) { writer.add_array(name, array); };
}

}  // namespace

void write_members(BundleWriter& writer, const MeshPart& part) {
  writer.add_text(part_json, text_of(part));
  visit_members_of_part(part, [&](const std::string& name, const auto& array) {
    if (!array.empty() || name != "mesh/tet_turned.npy") writer.add_array(name, array);
  });
}
void write_members(BundleWriter& writer, const MeshPiece& piece) {
  writer.add_text(piece_json, text_of(piece));
  visit_members_of_piece(piece, writing_to(writer));
}
void write_members(BundleWriter& writer, const CandidateKeys& keys) {
  visit_members_of_keys(keys, writing_to(writer));
}

void write_members(BundleWriter& writer, const TetMesh& mesh) {
  visit_members_of_mesh(mesh, writing_to(writer));
  if (mesh.ridges) writer.add_array(mesh_ridges, *mesh.ridges);
}
void write_members(BundleWriter& writer, const Candidates& candidates) {
  visit_members_of_candidates(candidates, writing_to(writer));
}
void write_members(BundleWriter& writer, const graph::ConflictGraph& graph) {
  visit_members_of_graph(graph, writing_to(writer));
}
void write_weights(BundleWriter& writer, const graph::ConflictGraph& graph) {
  writer.add_array(graph_weights, graph.weights);
}
void write_members(BundleWriter& writer, const graph::CliqueCover& cover) {
  visit_members_of_cover(cover, writing_to(writer));
}
void write_members(BundleWriter& writer, const graph::IndependentSet& solution) {
  visit_members_of_solution(solution, writing_to(writer));
}
void write_quads(BundleWriter& writer, const QuadsOfGraph& quads) {
  writer.add_array(graph_quads, quads);
}
void write_gap_members(BundleWriter& writer, const SolutionGaps& gaps) {
  visit_members_of_gaps(gaps, writing_to(writer));
}
void write_dislocations(BundleWriter& writer, const DislocationSegments& segments) {
  writer.add_array(mesh_dislocations, segments);
}
void write_members(BundleWriter& writer, const MixedMesh& result) {
  write_elements(writer, result);
  visit_members_of_result(result, writing_to(writer));
}

}  // namespace hexpipe::pipeline
