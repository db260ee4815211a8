// mesh_convert INPUT FORMAT OUTPUT [NAMES [PYRAMIDS [HEXES [no-facets [POLYHEDRA]]]]]: reads a mesh in any format and
// writes it in another, for the tests of the formats. NAMES: a text as names.json has it, the others as the tools' options;
// POLYHEDRA is none by default.

#include <cstdio>
#include <exception>
#include <string>

#include "formats/meshes/mesh_files.hpp"
#include "formats/meshes/solvers.hpp"

int main(int argc, char** argv) {
  using namespace hexpipe;
  using namespace hexpipe::formats;
  if (argc < 4 || argc > 9) {
    std::fprintf(stderr,
                 "usage: mesh_convert INPUT FORMAT OUTPUT [NAMES [PYRAMIDS [HEXES [no-facets [POLYHEDRA]]]]]\n");
    return 2;
  }
  try {
    Input input = Input::open(argv[1]);
    const MixedMesh mesh = read_mixed_mesh(input);
    const auto argument = [&](int i) { return std::string(i < argc ? argv[i] : ""); };
    MeshWriting writing = mesh_writing({.solver = "",
                                        .pyramids = argument(5),
                                        .hex_element = argument(6),
                                        .polyhedra = argc > 8 || argv[2] != poly_mesh_format ? argument(8) : "none",
                                        .no_facets = argument(7) == "no-facets"},
                                       argv[2]);
    if (!argument(4).empty()) writing.names = parse_group_names(argument(4), "names");
    writing.tell = [](const std::string& line) { std::fprintf(stderr, "mesh_convert: %s\n", line.c_str()); };
    if (argv[2] == poly_mesh_format) {
      const auto folder = open_mesh_folder(argv[3]);
      write_mesh_folder(mesh, *folder, writing);
      folder->commit();
      return 0;
    }
    Output output(argv[3]);
    write_mixed_mesh(mesh, argv[2], output, writing);
    output.commit();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mesh_convert: %s\n", error.what());
    return 1;
  }
  return 0;
}
