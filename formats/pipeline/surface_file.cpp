#include "formats/pipeline/surface_file.hpp"

#include "formats/meshes/mesh_surface.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/surface_bundle.hpp"

namespace hexpipe::pipeline {

formats::SurfaceSoup read_surface_file(const std::string& path) {
  formats::Input input = formats::Input::open(path);
  if (looks_like_bundle(input)) return read_surface_bundle(input, nullptr);
  return formats::looks_like_mesh_surface(input.peek(formats::bytes_that_tell_mesh)) ? formats::read_mesh_surface(input)
                                                                                     : formats::read_surface(input);
}

}  // namespace hexpipe::pipeline
