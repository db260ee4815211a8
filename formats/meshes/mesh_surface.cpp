#include "formats/meshes/mesh_surface.hpp"

#include <string>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "formats/meshes/abaqus.hpp"
#include "formats/meshes/library_formats.hpp"
#include "formats/meshes/medit.hpp"
#include "formats/meshes/mesh_files.hpp"
#include "formats/meshes/msh.hpp"
#include "formats/meshes/nastran.hpp"
#include "formats/meshes/su2.hpp"
#include "formats/meshes/vtk_legacy.hpp"
#include "formats/meshes/vtu.hpp"
#include "formats/streams/foreign_files.hpp"
#include "formats/streams/text_scanner.hpp"
#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {

bool looks_like_mesh_surface(std::string_view bytes) {
  bytes = without_byte_order_mark(bytes);
  std::string text;
  if (bytes.find_first_of(std::string_view("\n\0", 2)) == std::string_view::npos) {
    text = bytes;
    unify_line_ends(text);
    bytes = text;
  }
  if (looks_like_vtu(bytes) || looks_like_vtk_legacy(bytes) || looks_like_msh(bytes) || looks_like_medit(bytes))
    return true;
  if (looks_like_library_format(bytes)) return true;
  // These are told by less, which may stand in the header of a binary STL, too.
  if (bytes.find('\0') != std::string_view::npos || kind_of_foreign_file(bytes)) return false;
  return looks_like_abaqus(bytes) || looks_like_nastran(bytes) || looks_like_su2(bytes);
}

SurfaceSoup read_mesh_surface(Input& input) {
  GroupNames names;
  std::vector<std::string> warnings;
  const MixedMesh mesh = read_mixed_mesh(input, &names, &warnings);
  if (mesh.cell_count() > 0)
    throw DataError::at(input.name(),
                        "expected a surface, found a mesh of {} cells; findhex takes it where they are tets",
                        mesh.cell_count());
  SurfaceSoup soup;
  soup.name = input.name();
  soup.text = false;
  soup.points = mesh.points;
  soup.names.surfaces = std::move(names.surfaces);
  std::int64_t place = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    append_triangle(soup, mesh.triangles.cells[i], mesh.triangles.tags[i], ++place);
  PolygonReader polygons;
  SurfaceSoup of_quads;
  of_quads.points = mesh.points;
  for (std::size_t i = 0; i < mesh.quads.size(); ++i)
    polygons.append(of_quads, mesh.quads.cells[i], mesh.quads.tags[i], ++place);
  polygons.cut_concave(of_quads);
  for (std::size_t i = 0; i < of_quads.triangles.size(); ++i)
    append_triangle(soup, of_quads.triangles[i], of_quads.tags[i], of_quads.places[i]);
  soup.warnings = std::move(warnings);
  check_extent(soup);
  return merge_equal_points(std::move(soup));
}

}  // namespace hexpipe::formats
