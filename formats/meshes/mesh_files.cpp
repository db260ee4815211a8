#include "formats/meshes/mesh_files.hpp"

#include <algorithm>
#include <utility>

#include "common/curved/curved_validity.hpp"
#include "common/run/error.hpp"
#include "formats/meshes/abaqus.hpp"
#include "formats/meshes/facet_owners.hpp"
#include "formats/meshes/library_formats.hpp"
#include "formats/meshes/medit.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/meshes/msh.hpp"
#include "formats/meshes/nastran.hpp"
#include "formats/meshes/openfoam.hpp"
#include "formats/meshes/su2.hpp"
#include "formats/meshes/tetgen.hpp"
#include "formats/meshes/vtk_legacy.hpp"
#include "formats/meshes/vtu.hpp"
#include "formats/streams/foreign_files.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

struct MeshFormat {
  std::string_view name;
  void (*write)(const MixedMesh& mesh, const MeshWriting& writing, Output& output);
  bool second_order = false;  // takes such elements
};

template <MshVersion version, MshCoding coding>
void write_msh_as(const MixedMesh& mesh, const MeshWriting& writing, Output& output) {
  write_msh(mesh, version, coding, writing, output);
}

// Writes formats that have tags but no names; `writing` does not concern them.
template <void (*write)(const MixedMesh& mesh, Output& output)>
void write_tags(const MixedMesh& mesh, const MeshWriting&, Output& output) {
  write(mesh, output);
}

constexpr MeshFormat formats[] = {
    {"mesh", write_tags<write_medit>},
    {"msh", write_msh_as<MshVersion::v4_1, MshCoding::ascii>, true},
    {"msh-binary", write_msh_as<MshVersion::v4_1, MshCoding::binary>, true},
    {"msh22", write_msh_as<MshVersion::v2_2, MshCoding::ascii>, true},
    {"msh22-binary", write_msh_as<MshVersion::v2_2, MshCoding::binary>, true},
    {"vtk", write_tags<write_vtk_legacy>, true},
    {"vtu", write_tags<write_vtu>, true},
    {"inp", write_abaqus, true},
    {"su2", write_su2},
    {"bdf", write_nastran},
    {"nas", write_nastran},
#ifdef HEXPIPE_WITH_EXODUS
    {"exo", write_exodus, true},
    {"e", write_exodus, true},
#endif
#ifdef HEXPIPE_WITH_MED
    {"med", write_med, true},
#endif
#ifdef HEXPIPE_WITH_CGNS
    {"cgns", write_cgns},
#endif
};

MixedMesh read_mesh_by_content(Input& input, GroupNames* names, std::vector<std::string>* warnings) {
  std::string text = input.read_all();
  const std::string &name = input.name(), &path = input.path();
  if (looks_like_library_format(text))
    return read_by_library(std::move(text), name, input.is_decoded() ? "" : path, names);
  text.erase(0, text.size() - without_byte_order_mark(text).size());
  unify_line_ends(text);
  if (const auto kind = kind_of_foreign_file(text))
    throw DataError::at(name, "expected a mesh, found {}{}", kind->name, kind->remedy);
  if (looks_like_vtu(text)) return read_vtu(std::move(text), name, warnings);
  if (looks_like_vtk_legacy(text)) return read_vtk_legacy(text, name);
  if (looks_like_abaqus(text)) return read_abaqus(text, name, names);
  // Comments of Nastran begin like the sections of a .msh.
  if (looks_like_nastran(text)) return read_nastran(text, name, names);
  if (looks_like_msh(text)) return read_msh(text, name, names);
  if (looks_like_medit(text)) return read_medit(text, name, warnings);
  if (looks_like_tetgen(text)) return read_tetgen(text, name, path);
  if (looks_like_su2(text)) return read_su2(text, name, names);
  throw FormatError(name, 1,
                    fmt::format("expected a mesh (MEDIT .mesh, Gmsh .msh, VTK, VTU, TetGen .node or .ele, SU2, "
                                "Nastran, Abaqus, Exodus II, MED; "
                                "tetmesh makes one of a surface), found {}",
                                quote_found(TextScanner(text, name).peek_word())));
}

}  // namespace

MixedMesh read_mixed_mesh(Input& input, GroupNames* names, std::vector<std::string>* warnings) {
  MixedMesh mesh = read_mesh_by_content(input, names, warnings);
  validate(mesh, input.name().c_str());
  return mesh;
}

namespace {

// A mesh as its format can hold it, and how to write it.
struct Prepared {
  MixedMesh mesh;
  MeshWriting writing;
};

// How many tets of pyramids have a Jacobian that is not shown to be positive everywhere; they are the last ones.
std::size_t doubtful_tets(const MixedMesh& mesh, std::size_t first) {
  std::size_t count = 0;
  for (std::size_t i = first; i < mesh.tets.size(); ++i) {
    std::vector<Vec3> at;
    for (const Vertex v : mesh.tets.cells[i]) at.push_back(mesh.points[v]);
    for (const Vertex v : mesh.second_order->of(tet_names.vtk, i)) at.push_back(mesh.points[v]);
    count += curved::is_valid(CellKind::tet, at) ? 0 : 1;
  }
  return count;
}

void split_pyramids(Prepared& at) {
  const std::size_t pyramids = at.mesh.pyramids.size(), tets = at.mesh.tets.size();
  at.mesh = with_split_pyramids(at.mesh, &at.writing.tied);
  if (!at.mesh.second_order)
    return at.writing.say(
        fmt::format("{} pyramids are written as two tets each: their quads face two triangles", pyramids));
  at.writing.say(
      fmt::format("{} pyramids are written as four tets each; {} nodes on their bases belong to the tets "
                  "alone",
                  pyramids, at.writing.tied.size()));
  if (const std::size_t doubtful = doubtful_tets(at.mesh, tets); doubtful > 0)
    at.writing.say(fmt::format("{} of these tets are bent too much: they may not be valid everywhere", doubtful));
}

// Keeps the facets of the boundary; `nodes` are those of second order, or null. Returns how many go.
template <class Block>
std::size_t keep_outer(Block& block, const std::vector<FacetOwner>& owners, std::vector<Vertex>* nodes) {
  const std::size_t count = block.size(), nodes_of_each = nodes == nullptr || count == 0 ? 0 : nodes->size() / count;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (owners[i].cells > 1) continue;
    block.cells[kept] = block.cells[i];
    block.tags[kept] = block.tags[i];
    for (std::size_t k = 0; k < nodes_of_each; ++k)
      (*nodes)[kept * nodes_of_each + k] = (*nodes)[i * nodes_of_each + k];
    ++kept;
  }
  block.cells.resize(kept);
  block.tags.resize(kept);
  if (nodes != nullptr) nodes->resize(kept * nodes_of_each);
  return count - kept;
}

void leave_out_inner_facets(Prepared& at) {
  const FacetOwners owners = find_facet_owners(at.mesh);
  SecondOrder* const order = at.mesh.second_order ? &*at.mesh.second_order : nullptr;
  const std::size_t inner = keep_outer(at.mesh.triangles, owners.triangles, order ? &order->triangles : nullptr) +
                            keep_outer(at.mesh.quads, owners.quads, order ? &order->quads : nullptr);
  if (inner > 0)
    at.writing.say(fmt::format("{} facets that are not on the boundary are left out: the solver takes none", inner));
}

// The mesh without what the options leave out. Reports what that costs.
Prepared with_options(const MixedMesh& mesh, const MeshWriting& writing) {
  Prepared at{mesh, writing};
  if (at.writing.form_of_pyramids(mesh) == PyramidForm::split && mesh.pyramids.size() > 0) split_pyramids(at);
  if (!writing.facets) {
    at.mesh.triangles = {}, at.mesh.quads = {};
    if (at.mesh.second_order) at.mesh.second_order->triangles.clear(), at.mesh.second_order->quads.clear();
  } else if (!writing.inner_facets) {
    leave_out_inner_facets(at);
  }
  return at;
}

}  // namespace

bool takes_second_order(std::string_view format) {
  return std::ranges::any_of(formats,
                             [&](const MeshFormat& known) { return known.name == format && known.second_order; });
}

void write_mixed_mesh(const MixedMesh& mesh, std::string_view format, Output& output, const MeshWriting& writing) {
  for (const MeshFormat& known : formats) {
    if (known.name != format) continue;
    if (mesh.second_order && !known.second_order)
      throw DataError::at(output.name(),
                          "cannot write elements of second order as {}: use msh, vtu, vtk, inp, exo or med", format);
    const bool is_vtk_or_med = format == "vtk" || format == "vtu" || format == "med";
    if (mesh.second_order && mesh.second_order->full && mesh.pyramids.size() > 0 && is_vtk_or_med)
      writing.say(
          fmt::format("{} pyramids are written with 13 nodes: the format has none of 14", mesh.pyramids.size()));
    if (writing.facets && writing.inner_facets && writing.form_of_pyramids(mesh) == PyramidForm::keep)
      return known.write(mesh, writing, output);
    const Prepared prepared = with_options(mesh, writing);
    return known.write(prepared.mesh, prepared.writing, output);
  }
  throw UsageError(fmt::format("expected a mesh format, found {}", quote_found(format)));
}

std::unique_ptr<OutputFolder> open_mesh_folder(const std::string& path) {
  return open_poly_mesh(path);
}

void write_mesh_folder(const MixedMesh& mesh, OutputFolder& folder, const MeshWriting& writing) {
  const Prepared prepared = with_options(mesh, writing);
  write_openfoam(prepared.mesh, prepared.writing, folder);
}

const std::vector<std::string_view>& mesh_format_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> list;
    for (const MeshFormat& format : formats) list.push_back(format.name);
    return list;
  }();
  return names;
}

}  // namespace hexpipe::formats
