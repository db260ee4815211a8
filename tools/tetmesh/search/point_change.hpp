#pragma once
// Small random changes of the points where tets are left.

#include <utility>
#include <vector>

#include "common/run/random.hpp"
#include "tools/tetmesh/search/judged_mesh.hpp"
#include "tools/tetmesh/search/surface_change.hpp"
#include "tools/tetmesh/solid/surface_clearance.hpp"

namespace hexpipe::tetmesh::search {

struct PointChange {
  // The points inside.
  std::vector<Vertex> removed;
  std::vector<std::pair<Vertex, Vec3>> moved;  // with the new place
  std::vector<Vec3> added;

  SurfaceChange on_surface;

  bool is_nothing() const { return removed.empty() && moved.empty() && added.empty() && on_surface.is_nothing(); }
};

// Draws a change at a tet that is left. One of its points moves, goes, or joins another; a point comes to its middle,
// or to the middle of an edge on the surface; an edge there is flipped; or a hex is set on the hex beside the tet,
// and near points move to its corners, or new ones come.
class ChangeDrawer {
 public:
  // Vertices from `first_inside` on are inside. Without a `surface`, the surface stays as it is. All arguments must
  // outlive it.
  ChangeDrawer(const JudgedMesh& judged, Vertex first_inside, const solid::SurfaceClearance& clearance,
               const FlatSurface* surface);

  // `middle` is the tet's middle, and `size` the size there. The result is nothing if all that it drew is too near to
  // the surface, or outside.
  PointChange draw(TetIndex tet, const Vec3& middle, double size, Random& random) const;

 private:
  PointChange draw_any(TetIndex tet, const Vec3& middle, double size, Random& random) const;
  bool is_free(const Vec3& p, double size) const;
  bool is_inside(Vertex v) const { return v >= first_inside_; }
  PointChange move_one(Vertex v, double size, Random& random) const;
  PointChange join(Vertex v, double size) const;
  PointChange change_surface(Vertex v, double size, Random& random) const;
  PointChange add_one(const Vec3& middle, double size, Random& random) const;
  PointChange set_hex_on(TetIndex tet, double size, Random& random) const;
  Vertex nearest_to(const Vec3& place, std::span<const Vertex> around, double reach) const;

  const JudgedMesh& judged_;
  const TetMesh& mesh_;
  const TetAdjacency& adjacency_;
  Vertex first_inside_;
  const solid::SurfaceClearance& clearance_;
  const FlatSurface* surface_;
};

}  // namespace hexpipe::tetmesh::search
