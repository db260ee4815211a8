#pragma once
// What the command line says about a tool's inputs and output. tool_main declares these options;
// formats/pipeline/stage.hpp obeys them.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hexpipe {

// The products of the pipeline in the order in which they arise; each depends on the ones before it.
enum class Role { mesh, candidates, graph, solution, result };
inline constexpr std::array all_roles{Role::mesh, Role::candidates, Role::graph, Role::solution, Role::result};

constexpr const char* name_of(Role role) {
  constexpr const char* names[] = {"mesh", "candidates", "graph", "solution", "result"};
  return names[static_cast<int>(role)];
}

struct StreamOptions {
  std::optional<std::string> operand;  // a bundle, or a file of the tool's primary role; "-" is standard input
  std::map<Role, std::string> files;   // --mesh FILE and so on
  std::string output;                  // -o FILE; empty or "-": standard output
  std::string format;                  // --format; empty: by the ending of `output`, a bundle on standard output
  bool compress = false;               // bundles are written with zstd
};

}  // namespace hexpipe
