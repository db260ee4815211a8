#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include "common/run/error.hpp"
#include "common/run/run_context.hpp"
#include "formats/choice/cand.hpp"
#include "formats/choice/dimacs.hpp"
#include "formats/choice/graph_reading.hpp"
#include "formats/choice/metis.hpp"
#include "formats/choice/solution_file.hpp"
#include "formats/meshes/mesh_files.hpp"
#include "formats/meshes/mesh_surface.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/npy.hpp"
#include "formats/pipeline/stage.hpp"
#include "formats/points/size_files.hpp"
#include "formats/surfaces/surface_files.hpp"
#include "tests/fuzz/scratch_files.hpp"
#include "tests/fuzz/tar_members.hpp"
#include "tests/fuzz/targets.hpp"

namespace hexpipe {
using namespace formats;
using namespace graph;
using namespace pipeline;
namespace {

const ScratchFiles& scratch() {
  static const ScratchFiles files;
  return files;
}

Input memory(std::string_view bytes) {
  return Input::from_memory(std::string(bytes), "fuzzed");
}

// The output of `write`, as a file that is open again.
template <class Write>
Input written(const char* name, Write&& write) {
  const std::string path = scratch().path(name);
  Output output(path);
  write(output);
  output.commit();
  return Input::open(path);
}

// The parts of a mesh that every one of our mesh formats keeps.
bool same_mesh(const MixedMesh& a, const MixedMesh& b) {
  const auto same = [](const auto& x, const auto& y) { return x.cells == y.cells && x.tags == y.tags; };
  return a.points == b.points && same(a.hexes, b.hexes) && same(a.prisms, b.prisms) && same(a.pyramids, b.pyramids) &&
         same(a.tets, b.tets) && same(a.triangles, b.triangles) && same(a.quads, b.quads);
}

// Written and read again a mesh is the same mesh.
void check_round_trip(const MixedMesh& mesh, const char* format) {
  Input again = written("round_trip", [&](Output& output) { write_mixed_mesh(mesh, format, output); });
  promise(same_mesh(read_mixed_mesh(again), mesh), "a mesh that is written is read as the same mesh");
}

// The first bytes decide what is read, as in a tool: a mutated beginning leads to another reader or to none.
void read_mesh(std::string_view bytes, std::initializer_list<const char*> formats) {
  Input input = memory(bytes);
  const MixedMesh mesh = read_mixed_mesh(input);
  for (const char* const format : formats) check_round_trip(mesh, format);
}

// A mesh and its names, as a format holds them.
struct NamedMesh {
  MixedMesh mesh;
  GroupNames names;
};

NamedMesh named_mesh(std::string_view bytes) {
  NamedMesh result;
  Input input = memory(bytes);
  result.mesh = read_mixed_mesh(input, &result.names);
  return result;
}

bool same_cells(const MixedMesh& a, const MixedMesh& b) {
  return a.points.size() == b.points.size() && a.hexes.cells == b.hexes.cells && a.prisms.cells == b.prisms.cells &&
         a.pyramids.cells == b.pyramids.cells && a.tets.cells == b.tets.cells;
}

// The formats of solvers drop facets inside a mesh, shorten coordinates, change names and list facets by group. So the
// cells come back the same, and what has been through the format once stays as it is.
void read_solver_mesh(std::string_view bytes, const char* format) {
  const auto text_of = [&](const NamedMesh& one) {
    return written("solver_mesh",
                   [&](Output& output) { write_mixed_mesh(one.mesh, format, output, {.names = one.names}); })
        .read_all();
  };
  const NamedMesh first = named_mesh(bytes), second = named_mesh(text_of(first));
  promise(same_cells(first.mesh, second.mesh), "cells that are written are read as the same cells");
  const std::string text = text_of(second);
  promise(text_of(named_mesh(text)) == text, "what has been written before is written as the same bytes");
}

// The three files behind each other with a line between; the last may be missing.
void read_tetgen_files(std::string_view bytes) {
  constexpr std::string_view separator = "=====\n";
  scratch().remove("mesh.face");
  for (const char* const name : {"mesh.node", "mesh.ele", "mesh.face"}) {
    const std::size_t end = bytes.find(separator);
    scratch().write(name, bytes.substr(0, end));
    if (end == std::string_view::npos) break;
    bytes.remove_prefix(end + separator.size());
  }
  for (const char* const name : {"mesh.node", "mesh.ele"}) {
    Input input = Input::open(scratch().path(name));
    read_mixed_mesh(input);
  }
}

void read_candidates(std::string_view bytes) {
  Input input = memory(bytes);
  const Candidates candidates = read_cand(input);
  validate(candidates, "fuzzed");
  Input again = written("again.cand", [&](Output& output) { write_cand(candidates, output); });
  promise(read_cand(again) == candidates, "candidates that are written are read as the same candidates");
}

void read_graph(std::string_view bytes) {
  Input input = memory(bytes);
  const GraphFormat format = looks_like_dimacs(input) ? GraphFormat::dimacs : GraphFormat::metis;
  const ConflictGraph graph = read_graph(input, {.format = format});
  validate(graph, "fuzzed");
  metis_weight_warning(graph);
  Input again = written("again.graph", [&](Output& output) { write_metis(graph, output); });
  promise(read_graph(again, {.format = GraphFormat::metis}) == graph, "a graph that is written is read as the same graph");
}

// The first byte is the number of vertices.
void read_solution_of_few(std::string_view bytes) {
  if (bytes.empty()) return;
  Input input = memory(bytes.substr(1));
  const std::int64_t vertices = static_cast<unsigned char>(bytes.front());
  const IndependentSet solution = read_solution(input, vertices);
  promise(std::ranges::adjacent_find(solution, std::ranges::greater_equal{}) == solution.end(),
          "a solution is ascending");
  for (const std::int32_t v : solution) promise(v >= 0 && v < vertices, "a solution names vertices of the graph");
}

void check_soup(const SurfaceSoup& soup) {
  promise(soup.tags.size() == soup.triangles.size() && soup.places.size() == soup.triangles.size(),
          "each triangle has a tag and a place");
  for (const Vec3& point : soup.points) promise(is_place(point), "coordinates can be reckoned with");
  for (const Triangle& triangle : soup.triangles)
    for (const Vertex v : triangle)
      promise(v >= 0 && static_cast<std::size_t>(v) < soup.points.size(), "corners are points");
  soup.place_of(soup.triangles.size() - 1);
}

void read_soup(std::string_view bytes) {
  Input input = memory(bytes);
  check_soup(read_surface(input));
}

SurfaceSoup read_any_surface(std::string_view bytes) {
  Input input = memory(bytes);
  return looks_like_mesh_surface(input.peek(bytes_that_tell_mesh)) ? read_mesh_surface(input) : read_surface(input);
}

// The bytes are the parts inside, with lines between as in read_tetgen_files(): a checksum would stop nearly all
// mutations of the archive. All but the model may be missing.
void read_threemf(std::string_view bytes) {
  constexpr std::string_view separator = "=====\n";
  std::string zip(bytes.size() + 4096, '\0');
  std::size_t used = 0;
  archive* const out = archive_write_new();
  archive_write_set_format_zip(out);
  archive_write_set_options(out, "zip:compression=store");
  archive_write_open_memory(out, zip.data(), zip.size(), &used);
  for (const char* const name :
       {"3D/3dmodel.model", "3D/Objects/part.model", "_rels/.rels", "Metadata/model_settings.config"}) {
    const std::size_t end = bytes.find(separator);
    const std::string_view part = bytes.substr(0, end);
    archive_entry* const entry = archive_entry_new();
    archive_entry_set_pathname(entry, name);
    archive_entry_set_size(entry, static_cast<la_int64_t>(part.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_write_header(out, entry);
    archive_write_data(out, part.data(), part.size());
    archive_entry_free(entry);
    if (end == std::string_view::npos) break;
    bytes.remove_prefix(end + separator.size());
  }
  archive_write_free(out);
  read_soup(std::string_view(zip).substr(0, used));
}

void read_npy(std::string_view bytes) {
  const std::size_t size = npy_header_size(bytes.substr(0, 10));
  if (size == 0 || size > bytes.size()) return;
  const NpyHeader header = parse_npy_header(bytes.substr(0, size), "fuzzed");
  const std::string again = npy_header(header);
  promise(parse_npy_header(again, "again").shape == header.shape, "a header that is written is read as the same");
}

// As a tool that only reads: every role is taken where it is there, and validated.
void read_as_stage(std::string_view bytes) {
  RunContext context;
  context.info.name = "fuzzed";
  context.info.reads = {Role::mesh, Role::candidates, Role::graph, Role::solution, Role::result};
  context.common.quiet = true;
  context.streams.operand = scratch().write("stage.tar", bytes);
  Stage(context).read({.wants = context.info.reads, .cover = true});
}

void read_bundle(std::string_view bytes) {
  Input input = memory(bytes);
  if (looks_like_bundle(input)) read_as_stage(bytes);
}

void read_size_list(std::string_view bytes) {
  Input input = memory(bytes);
  const SizeList list = read_sizes(input);
  promise(list.points.empty() || list.points.size() == list.sizes.size(), "a size each");
  for (const auto& simplex : list.simplices)
    for (const Vertex v : simplex)
      promise(v == no_index || list.sizes.at(static_cast<std::size_t>(v)) > 0, "sizes are positive");
}

void read_members(std::string_view bytes) {
  read_bundle(with_right_checksums(bytes));
}

constexpr std::array readers{
    FuzzTarget{"bundle", read_bundle},
    FuzzTarget{"members", read_members, 0},
    FuzzTarget{"npy", read_npy},
    FuzzTarget{"medit", [](std::string_view bytes) { read_mesh(bytes, {"mesh"}); }},
    FuzzTarget{"msh",
               [](std::string_view bytes) {
                 read_mesh(bytes, {"msh", "msh-binary", "msh22", "msh22-binary"});
               }},
    FuzzTarget{"vtk", [](std::string_view bytes) { read_mesh(bytes, {"vtk"}); }},
    FuzzTarget{"vtu", [](std::string_view bytes) { read_mesh(bytes, {"vtu"}); }},
    FuzzTarget{"su2", [](std::string_view bytes) { read_solver_mesh(bytes, "su2"); }},
    FuzzTarget{"nastran", [](std::string_view bytes) { read_solver_mesh(bytes, "bdf"); }},
    FuzzTarget{"abaqus", [](std::string_view bytes) { read_solver_mesh(bytes, "inp"); }},
    FuzzTarget{"tetgen", read_tetgen_files},
    FuzzTarget{"metis", read_graph},
    FuzzTarget{"dimacs", read_graph},
    FuzzTarget{"cand", read_candidates},
    FuzzTarget{"sol", read_solution_of_few},
    FuzzTarget{"stl", read_soup},
    FuzzTarget{"obj", read_soup},
    FuzzTarget{"ply", read_soup},
    FuzzTarget{"off", read_soup},
    FuzzTarget{"packed", read_soup},
    FuzzTarget{"threemf", read_threemf},
    FuzzTarget{"mesh-surface", [](std::string_view bytes) { check_soup(read_any_surface(bytes)); }},
    FuzzTarget{"sizes", read_size_list},
};

}  // namespace

std::span<const FuzzTarget> reader_targets() {
  return readers;
}

}  // namespace hexpipe
