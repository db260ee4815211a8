// mesh_convert INPUT FORMAT OUTPUT: reads a mesh in any format and writes it in another, for the tests of the formats.

#include <cstdio>
#include <exception>

#include "formats/meshes/mesh_files.hpp"

int main(int argc, char** argv) {
  using namespace hexpipe;
  using namespace hexpipe::formats;
  if (argc != 4) {
    std::fprintf(stderr, "usage: mesh_convert INPUT FORMAT OUTPUT\n");
    return 2;
  }
  try {
    Input input = Input::open(argv[1]);
    const MixedMesh mesh = read_mixed_mesh(input);
    Output output(argv[3]);
    write_mixed_mesh(mesh, argv[2], output);
    output.commit();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mesh_convert: %s\n", error.what());
    return 1;
  }
  return 0;
}
