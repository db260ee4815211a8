#pragma once
// The command line of mesh-part as values.

#include <cstdint>
#include <string>

namespace hexpipe::mesh_part {

// As many as files of four digits name.
constexpr std::int32_t most_parts = 10000;

struct MeshPartOptions {
  std::int32_t parts = 1;
  std::uint64_t seed = 1;
  std::string directory;  // for the files of the parts
  bool compress = false;  // write the bundles with zstd
};

}  // namespace hexpipe::mesh_part
