#include "formats/meshes/solvers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "common/run/error.hpp"
#include "formats/meshes/mesh_files.hpp"

namespace hexpipe::formats {
namespace {

struct Solver {
  std::string_view name;
  std::vector<std::string_view> formats;
  PyramidForm pyramids;
  const char* hex_element;
  std::size_t longest_name = 0;
  bool inner_facets = true;
};

const std::vector<Solver>& solvers() {
  static const std::vector<Solver> list{
      // It has no pyramids. Hexes of full integration lock in bending: incompatible modes cure it.
      {"calculix", {"inp"}, PyramidForm::collapsed, "C3D8I"},
      {"abaqus", {"inp"}, PyramidForm::keep, "C3D8I"},
      {"openfoam", {"polyMesh", "msh22"}, PyramidForm::keep, "C3D8"},
      {"su2", {"su2"}, PyramidForm::keep, "C3D8"},
      {"nastran", {"bdf", "nas"}, PyramidForm::keep, "C3D8"},
      {"moose", {"e", "exo"}, PyramidForm::keep, "C3D8"},
      {"code-aster", {"med"}, PyramidForm::keep, "C3D8", 24},
      // It takes a facet between two cells for a mistake, and stops.
      {"dealii", {"msh", "msh-binary"}, PyramidForm::keep, "C3D8", 0, false},
  };
  return list;
}

const char* name_of(PyramidForm form) {
  switch (form) {
    case PyramidForm::collapsed:
      return "collapsed";
    case PyramidForm::split:
      return "split";
    case PyramidForm::keep:
      break;
  }
  return "kept";
}

}  // namespace

MeshWriting mesh_writing(const MeshOptions& options, std::string_view format) {
  MeshWriting writing;
  // Neither CalculiX nor Abaqus has pyramids of second order; tets with tied nodes find constant stresses, collapsed
  // hexes poor ones.
  if (format == "inp") writing.pyramids_of_second_order = PyramidForm::split;
  if (!options.solver.empty()) {
    const Solver& solver = *std::ranges::find(solvers(), options.solver, &Solver::name);
    if (std::ranges::find(solver.formats, format) == solver.formats.end())
      throw UsageError(
          fmt::format("--solver {} goes with {}, found {}", solver.name, fmt::join(solver.formats, " or "), format));
    writing.pyramids = solver.pyramids;
    writing.hex_element = solver.hex_element;
    writing.longest_name = solver.longest_name;
    writing.inner_facets = solver.inner_facets;
  }
  if (options.pyramids == "keep") writing.pyramids = PyramidForm::keep;
  if (options.pyramids == "collapsed") writing.pyramids = PyramidForm::collapsed;
  if (options.pyramids == "split") writing.pyramids = PyramidForm::split;
  if (!options.pyramids.empty()) writing.pyramids_of_second_order = writing.pyramids;
  if (writing.pyramids == PyramidForm::collapsed && format != "inp")
    throw UsageError(fmt::format("--pyramids collapsed goes with inp, which has such hexes, found {}", format));
  if (!options.hex_element.empty()) {
    if (format != "inp") throw UsageError(fmt::format("--hex-element goes with inp, found {}", format));
    writing.hex_element = options.hex_element;
  }
  if (!options.polyhedra.empty() && format != poly_mesh_format)
    throw UsageError(fmt::format("--polyhedra goes with polyMesh, found {}", format));
  writing.polyhedra = format == poly_mesh_format && options.polyhedra != "none";
  writing.facets = !options.no_facets;
  return writing;
}

void expect_second_order(const MeshOptions& options, std::string_view format, bool full) {
  if (!takes_second_order(format))
    throw UsageError(
        fmt::format("elements of second order go with msh, vtu, vtk, inp, exo, med or tar, found {}", format));
  if (format != "inp") return;
  if (full) throw UsageError("inp has no nodes in the middles of quads and hexes: use --nodes serendipity");
  if (options.pyramids == "keep")
    throw UsageError("inp has no pyramids of second order: use --pyramids split or collapsed, found keep");
  if (options.hex_element == "C3D8I")
    throw UsageError("--hex-element C3D8I has no element of second order: C3D8 gives C3D20, C3D8R gives C3D20R");
}

std::string solver_summary(const MeshOptions& options, const MeshWriting& writing) {
  if (options.solver.empty()) return "";
  const std::string hexes =
      options.solver == "calculix" || options.solver == "abaqus"
          ? fmt::format(", hexes are {} (of second order {})", writing.hex_element, writing.hex_of_second_order())
          : "";
  const std::string second = writing.pyramids_of_second_order == writing.pyramids
                                 ? ""
                                 : fmt::format(" (of second order {})", name_of(writing.pyramids_of_second_order));
  return fmt::format("for {}: pyramids are {}{}{}", options.solver, name_of(writing.pyramids), second, hexes);
}

}  // namespace hexpipe::formats
