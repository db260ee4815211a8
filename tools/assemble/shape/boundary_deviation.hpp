#pragma once
// The distance between the tagged facets of a result and the input's surface, both ways.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "common/mesh/vertex_items.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::shape {

class BoundaryDeviation {
 public:
  // `origin` as in Extract: all vertices on tagged facets are vertices of the input. Each call reads positions anew.
  // All arguments outlive this.
  BoundaryDeviation(const MixedMesh& mesh, const InputSurface& surface, std::span<const Vec3> input_points,
                    std::span<const Vertex> origin);

  bool has_moved(Vertex v) const { return mesh_.points[v] != input_points_[origin_[v]]; }

  // The greatest distance between the two surfaces around v: from the middles of the facets and edges at v to the
  // input's surface, and from the input's places of the corners of these facets to the facets around them. Only as
  // exact as it takes to compare it with `enough`; ends with the first distance above `most`.
  double around(Vertex v, double enough, double most) const;

  struct Summary {
    std::int64_t moved = 0;  // vertices on tagged facets
    double greatest = 0;     // distance as in around(), exact
  };
  Summary summary() const;

  // A vertex that is further than `tolerance` from the input's surface.
  std::optional<Vertex> vertex_off_surface(double tolerance) const;

 private:
  // The corners of a facet; a triangle repeats its last.
  Quad facet(std::int32_t f) const;
  double from_facet(std::int32_t f, double enough) const;
  double from_input_vertex(Vertex v, double enough) const;
  double to_facets_at(Vertex v, const Vec3& from) const;

  const MixedMesh& mesh_;
  const InputSurface& surface_;
  std::span<const Vec3> input_points_;
  std::span<const Vertex> origin_;
  // By vertex: its triangles, then its quads, which are numbered behind all triangles.
  VertexItems facets_;
};

}  // namespace hexpipe::assemble::shape
