#include "formats/meshes/mesh_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <system_error>

#include "common/run/error.hpp"
#include "common/run/run_context.hpp"

namespace hexpipe::formats {
namespace {

// Beside the program, wherever the whole was installed.
std::string path_of(std::string_view name) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return (program.parent_path() / HEXPIPE_MODULES / fmt::format("mesh_{}.so", name)).lexically_normal().string();
}

}  // namespace

const MeshLibrary& mesh_library(std::string_view name) {
  const std::string path = path_of(name);
  void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  // The message of the loader begins with the name of what it missed.
  if (module == nullptr) throw DataError(fmt::format("cannot load the module for the format: {}", dlerror()));
  const auto function = reinterpret_cast<const MeshLibrary* (*)()>(dlsym(module, mesh_library_function));
  if (function == nullptr) throw DataError::at(path, "expected a module of hexpipe, found another library");
  const MeshLibrary& library = *function();
  if (std::string_view(library.version) != version())
    throw DataError::at(path, "expected the module of hexpipe {}, found that of {}", version(), library.version);
  return library;
}

}  // namespace hexpipe::formats
