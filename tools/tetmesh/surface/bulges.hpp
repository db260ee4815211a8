#pragma once
// Where a smooth surface bends much within a size, new faces lie on one side of it, and further from it than they may.
// Their corners step out of it then, to the other side, so that no face is as far. Faces that may be as far bulge.

#include <cstdint>
#include <span>
#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"

namespace hexpipe::tetmesh::surface {

// The vertices that stay on the original surface: on features, of joints, of faces that are held, and those within
// reach of places where an earlier surface had a fault.
class FirmVertices {
 public:
  FirmVertices() = default;  // for meshes of which no vertex is asked for
  FirmVertices(const FeatureMesh& mesh, std::span<const std::vector<Vec3>* const> faults,
               const sizing::SizeField& reach);
  bool has(VertexH v) const { return is_firm_[v.idx()] != 0; }

 private:
  std::vector<std::uint8_t> is_firm_;  // by vertex
};

// Moves vertices that are not firm, of faces that are further than the deviation from points of the original surface,
// along their normals, by what exceeds nine tenths of the deviation: not so far that other faces around them leave it,
// or that a face turns by more than 35 degrees. `points` has those of the original surface by face, each beside the
// face that is nearest to it.
void step_out(FeatureMesh& mesh, std::span<const std::vector<Vec3>> points, const FirmVertices& firm,
              const sizing::SizeField& deviation);

}  // namespace hexpipe::tetmesh::surface
