#pragma once
// Merges two vertices along the surface, and what of the surface follows.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/assemble/gap/close_gaps.hpp"
#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::gap {

// The tagged triangles around a vertex, each with it first, in the order in which they follow each other.
struct Fan {
  std::vector<Triangle> triangles;
  std::vector<hybrid::TaggedTriangle> places;
};

// A merge that the surface allows.
struct SurfaceMerge {
  VertexMerge vertices;
  Fan fan;                   // around vertices.from
  std::vector<Tet> between;  // for each facet of one cell that moves, the tet that its move takes off
};

class SurfaceMerger {
 public:
  SurfaceMerger(GapMesh& gap, hybrid::SurfaceTags& tags, const shape::InputSurface& surface);

  // Both passes of passes.hpp.
  std::int64_t run();
  std::int64_t close_gaps();

  // How a becomes b, or b becomes a, or both one in the middle of the two where that leaves the surface as it is: the
  // first of these that the surface allows.
  template <class May>
  std::optional<SurfaceMerge> merge_of(Vertex a, Vertex b, May&& may) const;
  // The surface follows a merge; the cells do not.
  void finish(const SurfaceMerge& merge);

 private:
  struct Change {
    double gain = least_gain;
    Vertex into = no_index;
    std::vector<GapCell> in;
  };

  void move_gone(Vertex from, Vertex into);
  bool may_leave(Vertex v) const;
  std::optional<Fan> fan_of(Vertex v) const;
  std::vector<Vertex> goals_of(Vertex v, const Fan& fan) const;
  bool keeps_surface(Vertex from, Vertex into, const Fan& fan) const;
  bool keeps_shape(Vertex from, Vertex into, const Fan& fan) const;
  bool stays_near(Vertex from, Vertex into, const Fan& fan) const;
  bool is_in_quad(Vertex from, Vertex into, const Triangle& triangle) const;
  bool is_boundary_edge(Vertex into, Vertex other) const;
  void look_at(Vertex from, Vertex into, Change& best) const;
  std::vector<Tet> between(Vertex from, Vertex into, const Fan& fan) const;
  bool merge(Vertex from);
  void append_halves(CellKind kind, std::span<const Vertex> c, const Triangle& tagged, std::vector<Facet>& sides) const;
  bool may_close(Vertex from, Vertex into, const Fan& fan, double part) const;
  std::optional<SurfaceMerge> merge_of(Vertex from, Vertex into, double part) const;
  bool close_on_surface(Vertex a, Vertex b);
  bool close(Vertex a, Vertex b);

  GapMesh& gap_;
  GapCloser closer_{gap_};
  hybrid::SurfaceTags& tags_;
  const shape::InputSurface& surface_;
  std::vector<std::vector<hybrid::TaggedTriangle>> triangles_at_;
  std::vector<std::vector<Vec3>> gone_at_;  // by vertex: where vertices were that have merged into it
};

template <class May>
std::optional<SurfaceMerge> SurfaceMerger::merge_of(Vertex a, Vertex b, May&& may) const {
  for (const double part : {0.5, 0.0})
    for (const auto& [from, into] : {std::array{a, b}, std::array{b, a}})
      if (may(from, into))
        if (auto merge = merge_of(from, into, part)) return merge;
  return std::nullopt;
}

}  // namespace hexpipe::assemble::gap
