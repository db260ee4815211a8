#include "tools/tetmesh/surface/sheet_cut.hpp"

#include <array>
#include <numeric>
#include <span>

#include "common/mesh/joined_sets.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

using geometry::HalfEdge;

class SheetCutter {
 public:
  explicit SheetCutter(const solid::Surface& surface) : surface_(surface), corners_(3 * surface.triangles.size()) {}

  SheetCut cut() {
    geometry::for_each_edge(surface_.points.size(), surface_.triangles, [&](std::span<const HalfEdge> edge) {
      if (edge.size() == 2)
        stay_together(edge[0], edge[1]);
      else
        part(edge);
    });
    number_vertices();
    for (const HalfEdge h : at_joints_)
      result_.joints.emplace_back(geometry::start_of(result_.triangles, h), geometry::end_of(result_.triangles, h));
    geometry::for_each_edge(result_.point_of.size(), result_.triangles, [&](std::span<const HalfEdge> edge) {
      result_.is_manifold = result_.is_manifold && edge.size() <= 2;
    });
    return std::move(result_);
  }

 private:
  std::array<std::int32_t, 2> sides(HalfEdge h) const {
    const solid::Shell& sheet = surface_.shells[surface_.shell_of[geometry::triangle_of(h)]];
    return {sheet.behind, sheet.in_front};
  }

  void stay_together(HalfEdge h, HalfEdge twin) {
    corners_.join(h, geometry::next_in_triangle(twin));
    corners_.join(geometry::next_in_triangle(h), twin);
  }

  void part(std::span<const HalfEdge> edge) {
    at_joints_.insert(at_joints_.end(), edge.begin(), edge.end());
    const auto steps = geometry::walk_around_edge(surface_.points, surface_.triangles, edge);
    std::vector<bool> together(steps.size());
    for (const bool behind_both : {true, false})
      for (std::size_t i = 0; i < steps.size(); ++i) {
        const std::size_t next = (i + 1) % steps.size();
        if (together[i] || together[next]) continue;
        if (steps[i].is_along == behind_both || steps[next].is_along != behind_both) continue;
        const auto [behind, in_front] = sides(steps[i].half_edge);
        if (behind == in_front || sides(steps[next].half_edge) != std::array{behind, in_front}) continue;
        together[i] = together[next] = true;
        stay_together(steps[i].half_edge, steps[next].half_edge);
      }
  }

  // Corners that stayed together are one vertex. The first vertex at a point has the point's number.
  void number_vertices() {
    result_.point_of.resize(surface_.points.size());
    std::iota(result_.point_of.begin(), result_.point_of.end(), 0);
    std::vector<Vertex> number(3 * surface_.triangles.size(), no_index);  // by the lowest corner of each vertex
    std::vector<bool> is_taken(surface_.points.size());
    result_.triangles = surface_.triangles;
    for (HalfEdge corner = 0; corner < static_cast<HalfEdge>(number.size()); ++corner) {
      Vertex& here = result_.triangles[corner / 3][corner % 3];
      Vertex& known = number[corners_.of(corner)];
      if (known == no_index && is_taken[here]) {
        known = static_cast<Vertex>(result_.point_of.size());
        result_.point_of.push_back(here);
      } else if (known == no_index) {
        known = here;
        is_taken[here] = true;
      }
      here = known;
    }
  }

  const solid::Surface& surface_;
  JoinedSets corners_;  // corners of triangles, by their half-edges
  std::vector<HalfEdge> at_joints_;
  SheetCut result_;
};

}  // namespace

SheetCut cut_along_joints(const solid::Surface& surface) {
  return SheetCutter(surface).cut();
}

}  // namespace hexpipe::tetmesh::surface
