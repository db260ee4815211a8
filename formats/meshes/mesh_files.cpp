#include "formats/meshes/mesh_files.hpp"

#include <utility>

#include "common/run/error.hpp"
#include "formats/meshes/abaqus.hpp"
#include "formats/meshes/library_formats.hpp"
#include "formats/meshes/medit.hpp"
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
    {"msh", write_msh_as<MshVersion::v4_1, MshCoding::ascii>},
    {"msh-binary", write_msh_as<MshVersion::v4_1, MshCoding::binary>},
    {"msh22", write_msh_as<MshVersion::v2_2, MshCoding::ascii>},
    {"msh22-binary", write_msh_as<MshVersion::v2_2, MshCoding::binary>},
    {"vtk", write_tags<write_vtk_legacy>},
    {"vtu", write_tags<write_vtu>},
    {"inp", write_abaqus},
    {"su2", write_su2},
    {"bdf", write_nastran},
    {"nas", write_nastran},
#ifdef HEXPIPE_WITH_EXODUS
    {"exo", write_exodus},
    {"e", write_exodus},
#endif
#ifdef HEXPIPE_WITH_MED
    {"med", write_med},
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

// The mesh without what the options leave out; the mesh itself if they leave everything. Reports what that costs.
MixedMesh with_options(MixedMesh mesh, const MeshWriting& writing) {
  if (writing.pyramids == PyramidForm::split && mesh.pyramids.size() > 0) {
    writing.say(
        fmt::format("{} pyramids are written as two tets each: their quads face two triangles", mesh.pyramids.size()));
    mesh = with_split_pyramids(mesh);
  }
  if (!writing.facets) mesh.triangles = {}, mesh.quads = {};
  return mesh;
}

}  // namespace

void write_mixed_mesh(const MixedMesh& mesh, std::string_view format, Output& output, const MeshWriting& writing) {
  for (const MeshFormat& known : formats) {
    if (known.name != format) continue;
    if (writing.facets && writing.pyramids == PyramidForm::keep) return known.write(mesh, writing, output);
    return known.write(with_options(mesh, writing), writing, output);
  }
  throw UsageError(fmt::format("expected a mesh format, found {}", quote_found(format)));
}

std::unique_ptr<OutputFolder> open_mesh_folder(const std::string& path) {
  return open_poly_mesh(path);
}

void write_mesh_folder(const MixedMesh& mesh, OutputFolder& folder, const MeshWriting& writing) {
  write_openfoam(with_options(mesh, writing), writing, folder);
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
