#pragma once
// The vertices of a tet mesh as the nodes on which fields are solved: the links between them, and what the surface says
// about directions at its vertices.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/tetmesh/fields/octahedral.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::volume {

struct FieldLink {
  std::int32_t node;
  float weight;
};

// The directions known at a vertex of the surface.
struct SurfaceNode {
  enum class Kind : std::uint8_t {
    smooth,  // one axis is the normal; the triangles' legs may suggest the others
    fixed,   // on features whose normals and edges lie along the axes of one frame
    vague    // on other features: no frame fits, and one is suggested
  };
  Kind kind = Kind::smooth;
  bool is_on_interface = false;  // a region is on both sides of all that is around it
  Vec3 normal;
  fields::Frame frame{};  // of a fixed node
  fields::Harmonics suggested =
      fields::Harmonics::Zero();  // smooth: a cross, of norm 0 (no suggestion) to cross_norm; vague: a frame
};

struct FieldNodes {
  std::vector<Vec3> points;  // the surface's first
  std::vector<double> sizes;
  std::vector<SurfaceNode> surface;
  std::span<const Triangle> triangles;  // of the surface, which must outlive the nodes
  std::vector<std::int64_t> offsets;    // points + 1
  std::vector<FieldLink> links;         // in both directions

  std::size_t size() const { return points.size(); }
  bool is_on_surface(std::size_t node) const { return node < surface.size(); }
  std::span<const FieldLink> links_of(std::size_t node) const {
    return std::span(links).subspan(offsets[node], offsets[node + 1] - offsets[node]);
  }
};

// The first vertices of the mesh are those of the surface. Weights fall with the square of the distance in sizes.
FieldNodes make_field_nodes(const solid::Surface& surface, const TetMesh& mesh, const TetAdjacency& adjacency,
                            const sizing::SizeField& size, double feature_angle);

}  // namespace hexpipe::tetmesh::volume
