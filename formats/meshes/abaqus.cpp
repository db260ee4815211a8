#include "formats/meshes/abaqus.hpp"

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "formats/meshes/facet_owners.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/streams/number_writer.hpp"

namespace hexpipe::formats {
namespace {

struct AbaqusNames {
  CellKind kind;
  const char* type;
  // The number of Abaqus' face for each triangle and each quad of the topology.
  std::array<int, 4> triangle_faces;
  std::array<int, 6> quad_faces;
};

constexpr AbaqusNames names_by_kind[] = {
    {CellKind::hex, "C3D8", {}, {1, 2, 3, 4, 5, 6}},
    {CellKind::prism, "C3D6", {1, 2}, {3, 4, 5}},
    {CellKind::pyramid, "C3D5", {2, 3, 4, 5}, {1}},
    {CellKind::tet, "C3D4", {3, 4, 2, 1}, {}},
};

constexpr const AbaqusNames& abaqus_names(CellKind kind) {
  for (const AbaqusNames& names : names_by_kind)
    if (names.kind == kind) return names;
  return names_by_kind[0];
}

// Names of sets have no minus sign.
std::string set_name(const char* word, std::int32_t tag) {
  return tag < 0 ? fmt::format("{}_M{}", word, -static_cast<std::int64_t>(tag)) : fmt::format("{}_{}", word, tag);
}

class AbaqusWriter {
 public:
  AbaqusWriter(const MixedMesh& mesh, Output& output) : mesh_(mesh), output_(output) {}

  void write() {
    const FacetOwners owners = find_facet_owners(mesh_);
    output_.print("*HEADING\nhexpipe mesh\n");
    write_points();
    write_elements();
    write_regions();
    collect_surfaces(mesh_.triangles, owners.triangles, "triangles");
    collect_surfaces(mesh_.quads, owners.quads, "quads");
    write_surfaces();
  }

 private:
  using Face = std::pair<std::int64_t, int>;  // number of the element and of its face

  void write_points() {
    output_.print("*NODE, NSET=NALL\n");
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
      const Vec3& p = mesh_.points[i];
      output_.print("{}, {}, {}, {}\n", i + 1, p.x, p.y, p.z);
    }
  }

  // Elements are numbered from 1 through all blocks.
  void write_elements() {
    std::int64_t element = 1;
    for_each_block(mesh_, [&](const ElementNames& names, const auto& block) {
      if (names.dimension != 3) return;
      const auto kind = static_cast<CellKind>(names.vtk);
      first_element_[kind] = element;
      if (block.size() > 0) output_.print("*ELEMENT, TYPE={}, ELSET=EALL\n", abaqus_names(kind).type);
      for (const auto& cell : block.cells) {
        output_.print("{}", element++);
        for (const Vertex v : cell) output_.print(", {}", v + 1);
        output_.print("\n");
      }
    });
  }

  void write_regions() {
    std::map<std::int32_t, std::vector<std::int64_t>> elements;
    std::int64_t element = 1;
    for_each_block(mesh_, [&](const ElementNames& names, const auto& block) {
      if (names.dimension != 3) return;
      for (const std::int32_t tag : block.tags) elements[tag].push_back(element++);
    });
    for (const auto& [tag, list] : elements) {
      output_.print("*ELSET, ELSET={}\n", set_name("REGION", tag));
      // A data line has 16 entries at most.
      for (std::size_t i = 0; i < list.size(); ++i)
        output_.print("{}{}", list[i], i % 16 == 15 || i + 1 == list.size() ? "\n" : ", ");
    }
  }

  template <class Block>
  void collect_surfaces(const Block& facets, const std::vector<FacetOwner>& owners, const char* name) {
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const FacetOwner& owner = owners[i];
      if (owner.cell < 0)
        throw DataError::at(output_.name(),
                            "cannot write {}[{}]: Abaqus surfaces consist of facets of cells, and it is none", name, i);
      const AbaqusNames& names = abaqus_names(owner.kind);
      const auto facet = static_cast<std::size_t>(owner.facet);
      const int face = corners_of_block<Block> == 3 ? names.triangle_faces[facet] : names.quad_faces[facet];
      surfaces_[facets.tags[i]].emplace_back(first_element_[owner.kind] + owner.cell, face);
    }
  }

  void write_surfaces() {
    for (const auto& [tag, faces] : surfaces_) {
      output_.print("*SURFACE, NAME={}, TYPE=ELEMENT\n", set_name("SURFACE", tag));
      for (const auto& [element, face] : faces) output_.print("{}, S{}\n", element, face);
    }
  }

  const MixedMesh& mesh_;
  Output& output_;
  std::map<CellKind, std::int64_t> first_element_;
  std::map<std::int32_t, std::vector<Face>> surfaces_;
};

}  // namespace

void write_abaqus(const MixedMesh& mesh, Output& output) {
  AbaqusWriter(mesh, output).write();
}

}  // namespace hexpipe::formats
