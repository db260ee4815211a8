#include "formats/members.hpp"

namespace hexpipe {
namespace {

// Each list names the members of a role once, for reading and writing: visit(member name, array).

template <class Mesh, class Visit>
void visit_members_of_mesh(Mesh& mesh, Visit&& visit) {
  visit("mesh/points.npy", mesh.points);
  visit("mesh/tets.npy", mesh.tets);
  visit("mesh/tet_tags.npy", mesh.tet_tags);
  visit("mesh/triangles.npy", mesh.triangles);
  visit("mesh/triangle_tags.npy", mesh.triangle_tags);
}

template <class Cells, class Visit>
void visit_members_of_candidates(Cells& candidates, Visit&& visit) {
  visit("candidates/vertices.npy", candidates.vertices);
  visit("candidates/kind.npy", candidates.kind);
  visit("candidates/quality.npy", candidates.quality);
  visit("candidates/volume.npy", candidates.volume);
  visit("candidates/tet_offsets.npy", candidates.tet_offsets);
  visit("candidates/tets.npy", candidates.tets);
  visit("candidates/boundary_tet_offsets.npy", candidates.boundary_tet_offsets);
  visit("candidates/boundary_tets.npy", candidates.boundary_tets);
}

template <class Graph, class Visit>
void visit_members_of_graph(Graph& graph, Visit&& visit) {
  visit("graph/offsets.npy", graph.offsets);
  visit("graph/neighbours.npy", graph.neighbours);
  visit("graph/weights.npy", graph.weights);
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

template <class Mesh, class Visit>
void visit_members_of_result(Mesh& mesh, Visit&& visit) {
  visit("result/points.npy", mesh.points);
  auto cells = [&](const char* name, const char* tags, const char* quality, auto& block) {
    visit(name, block.cells);
    visit(tags, block.tags);
    visit(quality, block.quality);
  };
  cells("result/hexes.npy", "result/hexes_tags.npy", "result/hexes_quality.npy", mesh.hexes);
  cells("result/prisms.npy", "result/prisms_tags.npy", "result/prisms_quality.npy", mesh.prisms);
  cells("result/pyramids.npy", "result/pyramids_tags.npy", "result/pyramids_quality.npy", mesh.pyramids);
  cells("result/tets.npy", "result/tets_tags.npy", "result/tets_quality.npy", mesh.tets);
  visit("result/triangles.npy", mesh.triangles.cells);
  visit("result/triangles_tags.npy", mesh.triangles.tags);
  visit("result/quads.npy", mesh.quads.cells);
  visit("result/quads_tags.npy", mesh.quads.tags);
}

template <class T>
T& ensure(std::optional<T>& slot) {
  if (!slot) slot.emplace();
  return *slot;
}

}  // namespace

std::optional<Role> role_of_member(std::string_view name) {
  const std::string_view folder = name.substr(0, name.find('/'));
  for (const Role role : all_roles)
    if (folder == name_of(role) && folder.size() < name.size()) return role;
  return std::nullopt;
}

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
      break;
    case Role::result:
      visit_members_of_result(ensure(data.result), take);
      break;
  }
  return known;
}

namespace {

auto writing_to(BundleWriter& writer) {
  return [&writer](const char* name, const auto& array) { writer.add_array(name, array); };
}

}  // namespace

void write_members(BundleWriter& writer, const TetMesh& mesh) {
  visit_members_of_mesh(mesh, writing_to(writer));
}
void write_members(BundleWriter& writer, const Candidates& candidates) {
  visit_members_of_candidates(candidates, writing_to(writer));
}
void write_members(BundleWriter& writer, const ConflictGraph& graph) {
  visit_members_of_graph(graph, writing_to(writer));
}
void write_members(BundleWriter& writer, const CliqueCover& cover) {
  visit_members_of_cover(cover, writing_to(writer));
}
void write_members(BundleWriter& writer, const IndependentSet& solution) {
  visit_members_of_solution(solution, writing_to(writer));
}
void write_members(BundleWriter& writer, const MixedMesh& result) {
  visit_members_of_result(result, writing_to(writer));
}

}  // namespace hexpipe
