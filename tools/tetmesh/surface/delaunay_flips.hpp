#pragma once
// Flips on a half-edge mesh: Lawson's, which lead to triangles whose opposite angles add up to at most 180 degrees, and
// those of caps, whose long edge may be a feature.

#include <functional>
#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"

namespace hexpipe::tetmesh::surface {

// The four vertices around an edge: its ends, and the corners across it, left and right on the way from end 0 to end 1.
struct EdgeDiamond {
  std::array<OpenMesh::VertexHandle, 2> ends, across;
  std::array<Vec3, 2> end_points, across_points;

  EdgeDiamond(const FeatureMesh& mesh, OpenMesh::EdgeHandle e);

  // Whether the opposite angles of the two triangles exceed 180 degrees together, so that the edge should be flipped.
  bool is_beyond_delaunay() const;
  // The height of the tet of the four points over the larger of the two pairs of triangles. A flip moves the surface by
  // no more than that.
  double height() const;
  // The least cosine between a normal after the flip and the sum of the normals before it.
  double least_cosine_after_flip() const;
};

// A queue of edges that holds each edge once.
class EdgeQueue {
 public:
  void push(OpenMesh::EdgeHandle e) {
    if (waiting_.size() <= static_cast<std::size_t>(e.idx()))
      waiting_.resize(2 * static_cast<std::size_t>(e.idx()) + 1);
    if (waiting_[e.idx()]) return;
    waiting_[e.idx()] = true;
    edges_.push_back(e);
  }
  bool empty() const { return edges_.empty(); }
  OpenMesh::EdgeHandle pop() {
    const OpenMesh::EdgeHandle e = edges_.back();
    edges_.pop_back();
    waiting_[e.idx()] = false;
    return e;
  }

 private:
  std::vector<OpenMesh::EdgeHandle> edges_;
  std::vector<bool> waiting_;
};

// Flips edges of the queue, and edges that these flips make worth flipping, if allow(edge, diamond) agrees. allow() is
// asked only about flips that do not fold the surface, and before anything but the two triangles is read. done(edge) is
// called after each flip.
template <class Allow, class Done>
void flip_towards_delaunay(FeatureMesh& mesh, EdgeQueue& queue, Allow&& allow, Done&& done) {
  constexpr double least_cosine = 0.2;  // folds are refused with some reserve
  while (!queue.empty()) {
    const OpenMesh::EdgeHandle e = queue.pop();
    if (mesh.status(e).deleted() || mesh.is_feature(e)) continue;
    const EdgeDiamond diamond(mesh, e);
    if (!diamond.is_beyond_delaunay() || diamond.least_cosine_after_flip() < least_cosine) continue;
    if (!allow(e, diamond) || !mesh.is_flip_ok(e)) continue;
    mesh.flip(e);
    done(e);
    for (const int side : {0, 1}) {
      const auto h = mesh.halfedge_handle(e, static_cast<unsigned>(side));
      queue.push(mesh.edge_handle(mesh.next_halfedge_handle(h)));
      queue.push(mesh.edge_handle(mesh.prev_halfedge_handle(h)));
    }
  }
}

// An edge that was flipped. If it was a feature, that goes by another vertex now.
struct FlippedCap {
  VertexH start, end, by;
  bool was_feature;
  double moved;  // how far the feature is from where it was at first
};

// Flips features that are the long edge of a triangle whose third corner lies beside it, nearer than `nearest` and than
// a twentieth of its length. The feature then goes by that corner, and the triangle belongs to the other side. No
// feature moves by more than `nearest` in all, the other side turns by at most 60 degrees, and each tag with a name
// keeps triangles. Other such edges are flipped, too, where all three corners are on features. allow(half-edge, moved)
// is asked about each flip before it: the triangle is that of the half-edge, and `moved` is how far the feature will be
// from where it was at first. Returns the flips, in order.
std::vector<FlippedCap> flip_caps(FeatureMesh& mesh, const solid::Surface& surface, const sizing::SizeField& nearest,
                                  const std::function<bool(HalfEdgeH, double)>& allow);

}  // namespace hexpipe::tetmesh::surface
