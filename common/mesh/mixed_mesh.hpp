#pragma once
// A mesh of hexes, prisms, pyramids and tets with tagged boundary facets. assemble makes it, and all mesh formats read
// or write it.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/second_order.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

// Cells or facets of one kind. `tags` has one entry per cell; `quality` has one per cell or is empty.
template <int Corners>
struct CellBlock {
  std::vector<std::array<Vertex, Corners>> cells;
  std::vector<std::int32_t> tags;
  std::vector<double> quality;

  std::size_t size() const { return cells.size(); }
  bool operator==(const CellBlock&) const = default;
};

struct MixedMesh {
  std::vector<Vec3> points;
  CellBlock<8> hexes;
  CellBlock<6> prisms;
  CellBlock<5> pyramids;
  CellBlock<4> tets;
  CellBlock<3> triangles;  // boundary and interfaces; they point outward if they have an outside
  CellBlock<4> quads;
  std::optional<std::vector<Ridge>> ridges{};  // as in TetMesh
  std::optional<SecondOrder> second_order{};   // nodes behind the corners; their points follow all others

  std::size_t cell_count() const { return hexes.size() + prisms.size() + pyramids.size() + tets.size(); }
  bool operator==(const MixedMesh&) const = default;
};

// The same mesh in the other form. to_tet_mesh throws DataError naming `source` when there are cells other than tets.
MixedMesh to_mixed_mesh(TetMesh mesh);
TetMesh to_tet_mesh(MixedMesh mesh, const char* source);

// The mesh of the corners alone.
void drop_second_order(MixedMesh& mesh);

// Checks every block as validate(TetMesh) does.
void validate(const MixedMesh& mesh, const char* source);

}  // namespace hexpipe
