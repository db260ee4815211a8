#pragma once
// The options for a tool's inputs and output. tool_main declares them; formats/pipeline/stage.hpp obeys them.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hexpipe {

// The products of the pipeline in the order in which they are made; each depends on those before it.
enum class Role { mesh, candidates, graph, solution, result };
inline constexpr std::array all_roles{Role::mesh, Role::candidates, Role::graph, Role::solution, Role::result};

constexpr const char* name_of(Role role) {
  constexpr const char* names[] = {"mesh", "candidates", "graph", "solution", "result"};
  return names[static_cast<int>(role)];
}

// How to read a graph that comes from a file of its own (formats/choice/graph_reading.hpp).
struct GraphFileOptions {
  std::string format;  // empty: the first bytes tell
  std::optional<double> weight_scale;
  bool tolerant = false, complement = false;
  bool any() const { return !format.empty() || weight_scale || tolerant || complement; }
};

// How to write a mesh in a format of other programs.
struct MeshOptions {
  std::string solver;       // the program that will read it; empty: no particular one
  std::string pyramids;     // keep, collapsed or split; empty: what suits the solver, otherwise keep
  std::string hex_element;  // Abaqus' type of hexes; empty: what suits the solver, otherwise C3D8
  std::string polyhedra;    // mend or none, for a polyMesh; empty: mend
  bool no_facets = false;   // write cells only
};

struct StreamOptions {
  std::optional<std::string> operand;  // a bundle, or a file of the tool's first role; "-" is standard input
  std::map<Role, std::string> files;   // --mesh FILE and so on
  std::string output;                  // -o FILE; empty or "-": standard output
  std::string format;                  // --format; empty: `output`'s ending decides; standard output gets a bundle
  GraphFileOptions graph_file;
  bool compress = false;  // write bundles with zstd
  bool slim = false;      // leave the conflicts out of bundles
  MeshOptions mesh{};
};

}  // namespace hexpipe
