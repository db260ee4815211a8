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

// What the user says of a graph that comes from a file of its own (formats/choice/graph_reading.hpp).
struct GraphFileOptions {
  std::string format;  // empty: told by the first bytes
  std::optional<double> weight_scale;
  bool tolerant = false, complement = false;
  bool any() const { return !format.empty() || weight_scale || tolerant || complement; }
};

// How a mesh is written, in a format of other programs.
struct MeshOptions {
  std::string solver;       // the program that is to read it; empty: none in particular
  std::string pyramids;     // keep, collapsed or split; empty: as the solver takes them, else keep
  std::string hex_element;  // Abaqus' type of hexes; empty: as is best for the solver, else C3D8
  bool no_facets = false;   // cells alone
};

struct StreamOptions {
  std::optional<std::string> operand;  // a bundle, or a file of the tool's primary role; "-" is standard input
  std::map<Role, std::string> files;   // --mesh FILE and so on
  std::string output;                  // -o FILE; empty or "-": standard output
  std::string format;                  // --format; empty: by the ending of `output`, a bundle on standard output
  GraphFileOptions graph_file;
  bool compress = false;  // bundles are written with zstd
  MeshOptions mesh{};
};

}  // namespace hexpipe
