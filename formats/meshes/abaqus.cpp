#include "formats/meshes/abaqus.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "formats/meshes/element_nodes.hpp"
#include "formats/meshes/facet_owners.hpp"
#include "formats/meshes/group_naming.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/streams/number_writer.hpp"

namespace hexpipe::formats {
namespace {

// CalculiX silently cuts fields at this width: it keeps -9.52639091424853e-0 of -9.52639091424853e-05.
constexpr int field_width = 20;
// CalculiX reads lines of 132 characters, Abaqus of 256; both take 16 numbers a line.
constexpr std::size_t line_width = 80;
constexpr std::size_t most_in_line = 16;

constexpr NameRules abaqus_rules{
    .format = "Abaqus", .longest = 80, .others = "", .folds_case = true, .begins_with_letter = true};

struct AbaqusNames {
  CellKind kind;
  const char* type;
  const char* second_order;
  // The number of Abaqus' face for each triangle and each quad of the topology.
  std::array<int, 4> triangle_faces;
  std::array<int, 6> quad_faces;
};

constexpr AbaqusNames names_by_kind[] = {
    {CellKind::hex, "C3D8", "C3D20", {}, {1, 2, 3, 4, 5, 6}},
    {CellKind::prism, "C3D6", "C3D15", {1, 2}, {3, 4, 5}},
    {CellKind::pyramid, "C3D5", nullptr, {2, 3, 4, 5}, {1}},
    {CellKind::tet, "C3D4", "C3D10", {3, 4, 2, 1}, {}},
};
// The nodes of this hex.
constexpr std::string_view collapsed_nodes = "0 1 2 3 4 4 4 4",
                           collapsed_nodes_of_second_order = "0 1 2 3 4 4 4 4 01 12 23 30 4 4 4 4 04 14 24 34";
// A pyramid as a hex whose upper four corners are the apex: its sides are the hex's.
constexpr AbaqusNames collapsed_pyramid{CellKind::pyramid, "C3D8", "C3D20", {3, 4, 5, 6}, {1}};

class AbaqusWriter {
 public:
  AbaqusWriter(const MixedMesh& mesh, const MeshWriting& writing, Output& output)
      : mesh_(mesh),
        writing_(writing),
        output_(output),
        names_(mesh, writing, abaqus_rules, {"EALL", "NALL", "NTIED"}),
        lister_(mesh, lists()),
        is_tied_(mesh.points.size()) {
    for (const TiedNode& tied : writing.tied) is_tied_[static_cast<std::size_t>(tied.node)] = true;
  }

  void write() {
    check_numbers(std::max(mesh_.points.size(), element_count(mesh_)), most_of_31_bits, output_.name());
    refuse_what_abaqus_lacks();
    const FacetOwners owners = find_facet_owners(mesh_);
    output_.print("*HEADING\nhexpipe mesh\n");
    write_points();
    write_elements();
    write_tied_nodes();
    collect_faces(mesh_.triangles, owners.triangles, "triangles");
    collect_faces(mesh_.quads, owners.quads, "quads");
    write_regions();
    write_surfaces();
  }

 private:
  using Face = std::pair<std::int64_t, int>;  // number of the element and of its face
  struct Group {
    std::vector<std::int64_t> elements;
    std::vector<std::int64_t> nodes;
    std::vector<Face> faces;
  };
  using Groups = std::map<std::string, Group>;

  bool collapses(CellKind kind) const {
    return kind == CellKind::pyramid && writing_.form_of_pyramids(mesh_) == PyramidForm::collapsed;
  }
  NodeLists lists() const {
    NodeLists result = abaqus_nodes;
    if (collapses(CellKind::pyramid))
      result.pyramid = mesh_.second_order ? collapsed_nodes_of_second_order : collapsed_nodes;
    return result;
  }

  void refuse_what_abaqus_lacks() const {
    if (!mesh_.second_order) return;
    if (mesh_.second_order->full)
      throw DataError::at(output_.name(),
                          "cannot write nodes in the middles of quads and hexes: use --nodes serendipity");
    if (mesh_.pyramids.size() > 0 && writing_.form_of_pyramids(mesh_) == PyramidForm::keep)
      throw DataError::at(output_.name(),
                          "cannot write {} pyramids of second order, which Abaqus lacks: use --pyramids split or "
                          "collapsed",
                          mesh_.pyramids.size());
  }
  const AbaqusNames& abaqus_names(CellKind kind) const {
    if (collapses(kind)) return collapsed_pyramid;
    return *std::ranges::find(names_by_kind, kind, &AbaqusNames::kind);
  }
  std::string type_of(CellKind kind) const {
    if (mesh_.second_order)
      return kind == CellKind::hex ? writing_.hex_of_second_order() : abaqus_names(kind).second_order;
    return kind == CellKind::hex ? writing_.hex_element : abaqus_names(kind).type;
  }

  void write_points() {
    const double negligible = negligible_length(mesh_);
    const auto text = [&](double x) { return number_within(std::abs(x) < negligible ? 0 : x, field_width); };
    const auto write = [&](bool tied) {
      for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
        if (is_tied_[i] != tied) continue;
        const Vec3& p = mesh_.points[i];
        output_.print("{}, {}, {}, {}\n", i + 1, text(p.x), text(p.y), text(p.z));
      }
    };
    output_.print("*NODE, NSET=NALL\n");
    write(false);
    if (writing_.tied.empty()) return;
    output_.print("*NODE, NSET=NTIED\n");
    write(true);
  }

  // Elements are numbered from 1 through all blocks.
  void write_elements() {
    std::int64_t element = 1;
    for_each_block(mesh_, [&](const ElementNames& names, const auto& block) {
      if (names.dimension != 3) return;
      const auto kind = static_cast<CellKind>(names.vtk);
      first_element_[kind] = element;
      if (block.size() > 0) output_.print("*ELEMENT, TYPE={}, ELSET=EALL\n", type_of(kind));
      for (std::size_t i = 0; i < block.size(); ++i) {
        Group& region = region_groups_[names_.regions.of(block.tags[i])];
        region.elements.push_back(element);
        output_.print("{}", element++);
        std::size_t in_line = 1;
        for (const Vertex v : lister_.nodes(names.vtk, block, i)) {
          output_.print("{}{}", in_line == most_in_line ? ",\n" : ", ", v + 1);
          in_line = in_line % most_in_line + 1;
        }
        output_.print("\n");
        for (const Vertex v : block.cells[i]) region.nodes.push_back(v + 1);
        if (!mesh_.second_order) continue;
        for (const Vertex v : mesh_.second_order->of(names.vtk, i)) region.nodes.push_back(v + 1);
      }
    });
  }

  void write_tied_nodes() {
    for (const TiedNode& tied : writing_.tied)
      for (int axis = 1; axis <= 3; ++axis) {
        output_.print("*EQUATION\n{}\n{}, {}, 1", tied.terms.size() + 1, tied.node + 1, axis);
        // Four terms a line.
        for (std::size_t i = 0; i < tied.terms.size(); ++i)
          output_.print("{}{}, {}, {}", i % 4 == 3 ? ",\n" : ", ", tied.terms[i].node + 1, axis, -tied.terms[i].factor);
        output_.print("\n");
      }
  }

  template <class Block>
  void collect_faces(const Block& facets, const std::vector<FacetOwner>& owners, const char* name) {
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const FacetOwner& owner = owners[i];
      if (owner.cell == no_index)
        throw DataError::at(output_.name(),
                            "cannot write {}[{}]: Abaqus surfaces consist of facets of cells, and it is none", name, i);
      const AbaqusNames& names = abaqus_names(owner.kind);
      const auto facet = static_cast<std::size_t>(owner.facet);
      const int face = corners_of_block<Block> == 3 ? names.triangle_faces[facet] : names.quad_faces[facet];
      Group& surface = surface_groups_[names_.surfaces.of(facets.tags[i])];
      surface.faces.emplace_back(first_element_[owner.kind] + owner.cell, face);
      for (const Vertex v : facets.cells[i]) surface.nodes.push_back(v + 1);
      if (!mesh_.second_order) continue;
      constexpr std::uint8_t vtk = corners_of_block<Block> == 3 ? vtk_code_of_triangle : vtk_code_of_quad;
      for (const Vertex v : mesh_.second_order->of(vtk, i)) surface.nodes.push_back(v + 1);
    }
  }

  void write_set(const char* keyword, const std::string& name, const std::vector<std::int64_t>& numbers) {
    output_.print("*{0}, {0}={1}\n", keyword, name);
    std::string line;
    std::size_t in_line = 0;
    for (const std::int64_t number : numbers) {
      std::string entry = std::to_string(number);
      if (in_line == most_in_line || line.size() + 2 + entry.size() > line_width) {
        output_.print("{}\n", line);
        line.clear();
        in_line = 0;
      }
      line += (in_line++ == 0 ? "" : ", ") + entry;
    }
    output_.print("{}\n", line);
  }

  // Without tied nodes: CalculiX stops where one is fixed, too.
  void write_node_set(const std::string& name, std::vector<std::int64_t>& nodes) {
    std::erase_if(nodes, [&](std::int64_t number) { return is_tied_[static_cast<std::size_t>(number - 1)]; });
    std::ranges::sort(nodes);
    nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
    write_set("NSET", name, nodes);
  }

  void write_regions() {
    for (const std::string& name : names_.regions.list()) {
      write_set("ELSET", name, region_groups_[name].elements);
      write_node_set(name, region_groups_[name].nodes);
    }
  }

  void write_surfaces() {
    for (const std::string& name : names_.surfaces.list()) {
      write_node_set(name, surface_groups_[name].nodes);
      output_.print("*SURFACE, NAME={}, TYPE=ELEMENT\n", name);
      for (const auto& [element, face] : surface_groups_[name].faces) output_.print("{}, S{}\n", element, face);
    }
  }

  const MixedMesh& mesh_;
  const MeshWriting& writing_;
  Output& output_;
  GroupNamings names_;
  NodeLister lister_;
  std::vector<bool> is_tied_;  // by point: whether equations give its displacement
  std::map<CellKind, std::int64_t> first_element_;
  Groups region_groups_, surface_groups_;
};

}  // namespace

void write_abaqus(const MixedMesh& mesh, const MeshWriting& writing, Output& output) {
  AbaqusWriter(mesh, writing, output).write();
}

}  // namespace hexpipe::formats
