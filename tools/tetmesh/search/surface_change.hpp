#pragma once
// Changes of a surface's triangles that leave the surface where it is: points move, go and come within flat faces and
// along straight edges, and two triangles of a flat face exchange their diagonal.

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/vertex_items.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::search {

struct NewTriangle {
  Triangle corners;         // -1 for the point that comes
  std::int32_t instead_of;  // of this triangle it has shell, tag and place
};

struct SurfaceChange {
  std::optional<std::pair<Vertex, Vec3>> moved;  // to where
  std::optional<Vertex> removed;
  std::optional<Vec3> added;
  std::vector<std::int32_t> removed_triangles;
  std::vector<NewTriangle> added_triangles;

  bool is_nothing() const { return !moved && removed_triangles.empty(); }
};

// What may be changed at a vertex. No triangle is turned over, or made smaller than a twentieth of the size's square.
// The surface must outlive it.
class FlatSurface {
 public:
  explicit FlatSurface(const solid::Surface& surface);

  // By the part of the step that lies in the face, or along the edge.
  SurfaceChange move(Vertex v, const Vec3& step, double size) const;
  // v becomes its neighbour `to`.
  SurfaceChange collapse(Vertex v, Vertex to, double size) const;
  // A point comes to the middle of an edge.
  SurfaceChange split(Vertex a, Vertex b, double size) const;
  // The edge gives way to the one between the corners opposite.
  SurfaceChange flip(Vertex a, Vertex b, double size) const;

  // Ascending.
  std::vector<Vertex> neighbours_of(Vertex v) const;

 private:
  // How a vertex may move: within a plane, along a line, not at all.
  struct Freedom {
    int dimensions = 0;
    Vec3 direction{};                         // normal of the plane, or along the line; unit length
    std::pair<Vertex, Vertex> along{-1, -1};  // the neighbours on the line
  };

  std::vector<std::int32_t> triangles_of_edge(Vertex a, Vertex b) const;
  bool is_of_one_face(std::int32_t t, std::int32_t u) const;
  Freedom freedom_of(Vertex v) const;
  Vec3 normal_of(const Triangle& t) const;
  bool keeps(std::int32_t triangle, const Vec3& a, const Vec3& b, const Vec3& c, double size) const;

  const solid::Surface& surface_;
  VertexItems triangles_;
};

// With changes that have no triangle in common. Vertices that stay keep their order; those that come are last.
solid::Surface with_changes(const solid::Surface& surface, std::span<const SurfaceChange* const> changes);

}  // namespace hexpipe::tetmesh::search
