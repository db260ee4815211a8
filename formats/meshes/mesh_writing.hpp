#pragma once
// How a mesh is to be written apart from its format: what solvers want and formats allow.

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/streams/group_names.hpp"

namespace hexpipe::formats {

// keep: as pyramids. collapsed: as hexes with the apex four times. split: as two tets each; of second order,
// as four.
enum class PyramidForm { keep, collapsed, split };

// A node of second order on a quad whose element has none there: it moves as that place of the quad does.
struct TiedNode {
  struct Term {
    Vertex node;
    double factor;
  };
  Vertex node;
  std::vector<Term> terms;
};

struct MeshWriting {
  GroupNames names{};
  PyramidForm pyramids = PyramidForm::keep;
  PyramidForm pyramids_of_second_order = PyramidForm::keep;
  bool facets = true;        // false: cells alone, for readers that take no facets among them
  bool inner_facets = true;  // false: no facets between two cells, for readers that take only those of the boundary
  std::string hex_element = "C3D8";  // Abaqus' type of hexes
  std::size_t longest_name = 0;      // of a group, where the solver takes less than the format holds; 0: it does not
  std::vector<TiedNode> tied{};      // in the mesh: what with_split_pyramids left between tets and others
  bool polyhedra = false;  // in a polyMesh: where checkMesh finds fault, cells become polyhedra (formats/polyhedra)
  // Hears what the writer had to change, a line each. May be empty.
  std::function<void(const std::string&)> tell{};

  PyramidForm form_of_pyramids(const MixedMesh& mesh) const {
    return mesh.second_order ? pyramids_of_second_order : pyramids;
  }
  const char* hex_of_second_order() const { return hex_element == "C3D8R" ? "C3D20R" : "C3D20"; }
  void say(const std::string& line) const {
    if (tell) tell(line);
  }
};

// The mesh with two tets for each pyramid. The diagonal of a base begins at its lowest vertex, so that two pyramids on
// one base agree. A facet that only pyramids have becomes two triangles. Beside a hex or a prism it stays a quad whose
// other side is two triangles now: vertices fit, but the mesh no longer conforms there, and finite elements do not pass
// the patch test.
//
// A pyramid of second order becomes four tets around the line from the middle of its base to the apex. They add five
// nodes to the base: its middle, which is a corner of theirs, and those between the middle and its corners. Where
// something else has the quad on its other side, these go into `tied`: fields of second degree are continuous then, and
// constant stresses are found exactly where bases are parallelograms.
MixedMesh with_split_pyramids(const MixedMesh& mesh, std::vector<TiedNode>* tied = nullptr);

// Throws DataError, beginning with `name`, if there are more points or elements than a format can number.
inline constexpr std::size_t most_of_31_bits = 2147483647;
void check_numbers(std::size_t count, std::size_t most, std::string_view name);

// A length that is negligible in the mesh: 1e-15 of the diagonal of its bounding box. Formats with short fields write
// smaller coordinates as 0, because they would take digits.
double negligible_length(const MixedMesh& mesh);

}  // namespace hexpipe::formats
