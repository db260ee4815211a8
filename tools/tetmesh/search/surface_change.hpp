#pragma once
// Changes of a surface's triangles that leave the surface where it is: points move, go and come within flat faces and
// along straight edges, and edges within a flat face are flipped.

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/vertex_items.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::search {

struct NewTriangle {
  Triangle corners;         // no_index for the point that comes
  std::int32_t instead_of;  // shell, tag and place are those of this triangle
};

struct SurfaceChange {
  std::optional<std::pair<Vertex, Vec3>> moved;  // with the new place
  std::optional<Vertex> removed;
  std::optional<Vec3> added;
  std::vector<std::int32_t> removed_triangles;
  std::vector<NewTriangle> added_triangles;

  bool is_nothing() const { return !moved && removed_triangles.empty(); }
};

// The changes that are possible at a vertex. They turn no triangle over, and make none smaller than a twentieth of the
// size's square. The surface must outlive it.
class FlatSurface {
 public:
  explicit FlatSurface(const solid::Surface& surface);

  // Moves the vertex by the component of the step in the face, or along the edge.
  SurfaceChange move(Vertex v, const Vec3& step, double size) const;
  // v becomes its neighbour `to`.
  SurfaceChange collapse(Vertex v, Vertex to, double size) const;
  // Adds a point in the middle of an edge.
  SurfaceChange split(Vertex a, Vertex b, double size) const;
  // Replaces the edge by the one between the corners opposite it.
  SurfaceChange flip(Vertex a, Vertex b, double size) const;

  // In ascending order.
  std::vector<Vertex> neighbours_of(Vertex v) const;

 private:
  // How a vertex may move: within a plane, along a line, or not at all.
  struct Freedom {
    int dimensions = 0;
    Vec3 direction{};  // the normal of the plane, or the direction of the line; of length 1
    std::pair<Vertex, Vertex> along{no_index, no_index};  // the neighbours on the line
  };

  std::vector<std::int32_t> triangles_of_edge(Vertex a, Vertex b) const;
  bool is_of_one_face(std::int32_t t, std::int32_t u) const;
  Freedom freedom_of(Vertex v) const;
  Vec3 normal_of(const Triangle& t) const;
  bool keeps(std::int32_t triangle, const Vec3& a, const Vec3& b, const Vec3& c, double size) const;

  const solid::Surface& surface_;
  VertexItems triangles_;
};

// The changes must have no triangle in common. Vertices that stay keep their order; new ones are last.
solid::Surface with_changes(const solid::Surface& surface, std::span<const SurfaceChange* const> changes);

}  // namespace hexpipe::tetmesh::search
