#include "tools/assemble/order/fit_corners.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/defaults.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/mesh/vertex_items.hpp"
#include "tools/assemble/order/boundary_edges.hpp"

namespace hexpipe::assemble::order {
namespace {

// Vertices that slid are up to shape::most_deviation off; this is far enough for them, and not for other walls.
constexpr double most_way = 0.1;  // in lengths of the shortest edge there: layers at walls are thin
// Corners that are nearer, in the same lengths, are on the surface.
constexpr double on_surface = 1e-9;
constexpr double kept_quality = 0.9;

struct VertexSurroundings {
  Vec3 normal;  // the sum of those of smooth edges, or the direction of sharp ones
  int edges = 0, sharp = 0;
  std::array<Vertex, 2> ends{};
  double shortest = std::numeric_limits<double>::infinity();  // of all edges there, those inside, too
};

struct CellCorners {
  CellKind kind;
  std::span<const Vertex> corners;
};

class CornerFitter {
 public:
  CornerFitter(MixedMesh& mesh, const GivenSurface& surface) : mesh_(mesh), surface_(surface) {
    const auto list = [&](CellKind kind, const auto& block) {
      for (const auto& cell : block.cells) cells_.push_back({kind, cell});
    };
    list(CellKind::hex, mesh.hexes);
    list(CellKind::prism, mesh.prisms);
    list(CellKind::pyramid, mesh.pyramids);
    list(CellKind::tet, mesh.tets);
    cells_at_ = VertexItems(mesh.points.size(), [&](auto&& visit) {
      for (std::size_t c = 0; c < cells_.size(); ++c)
        for (const Vertex v : cells_[c].corners) visit(v, static_cast<std::int32_t>(c));
    });
  }

  FitCounts run() {
    look_around();
    for (std::size_t v = 0; v < around_.size(); ++v) fit(static_cast<Vertex>(v));
    return counts_;
  }

 private:
  void look_around() {
    around_.resize(mesh_.points.size());
    for (const BoundaryEdge& edge : boundary_edges(mesh_))
      for (const auto& [v, other] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
        VertexSurroundings& here = around_[static_cast<std::size_t>(v)];
        ++here.edges;
        here.normal += edge.normal;
        if (edge.is_sharp && here.sharp++ < 2) here.ends[static_cast<std::size_t>(here.sharp - 1)] = other;
      }
    for (const CellCorners& cell : cells_)
      with_topology(cell.kind, [&](auto topology) {
        for (const auto& e : decltype(topology)::edges) {
          const auto a = static_cast<std::size_t>(cell.corners[e[0]]), b = static_cast<std::size_t>(cell.corners[e[1]]);
          const double length = norm(mesh_.points[a] - mesh_.points[b]);
          for (const std::size_t v : {a, b}) around_[v].shortest = std::min(around_[v].shortest, length);
        }
      });
  }

  std::optional<Vec3> place_of(Vertex v, const VertexSurroundings& here) const {
    const Vec3& from = mesh_.points[v];
    const double most = most_way * here.shortest;
    if (here.sharp == 0) return surface_.on_faces(from, unit(here.normal), most);
    const Vec3 one = unit(mesh_.points[here.ends[0]] - from), two = unit(mesh_.points[here.ends[1]] - from);
    return surface_.on_curves(from, unit(one - two), most);
  }

  bool turns(Vertex v, const VertexSurroundings& here) const {
    const Vec3 &from = mesh_.points[v], &one = mesh_.points[here.ends[0]], &two = mesh_.points[here.ends[1]];
    return dot(unit(one - from), unit(two - from)) > -cosine_of_degrees(default_feature_angle);
  }

  void fit(Vertex v) {
    const VertexSurroundings& here = around_[static_cast<std::size_t>(v)];
    if (here.edges == 0 || here.sharp == 1 || here.sharp > 2 || (here.sharp == 2 && turns(v, here))) return;
    const std::optional<Vec3> to = place_of(v, here);
    const Vec3 from = mesh_.points[v];
    const double way = to ? norm(*to - from) : 0;
    if (to && way <= on_surface * here.shortest) return;
    if (!to || !keeps_cells_good(v, *to)) {
      ++counts_.held;
      return;
    }
    ++counts_.moved;
    counts_.farthest = std::max(counts_.farthest, way);
  }

  // Moves v if it does.
  bool keeps_cells_good(Vertex v, const Vec3& to) {
    const std::span<const std::int32_t> cells = cells_at_.at(v);
    std::vector<double> before;
    for (const std::int32_t c : cells) before.push_back(quality(c));
    const Vec3 from = std::exchange(mesh_.points[v], to);
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (!is_valid_cell(cells[i]) || quality(cells[i]) < kept_quality * before[i]) {
        mesh_.points[v] = from;
        return false;
      }
    return true;
  }

  double quality(std::int32_t c) const {
    const CellCorners& cell = cells_[static_cast<std::size_t>(c)];
    const auto at = corner_points(mesh_.points, cell.corners);
    return least_corner_scaled_jacobian(cell.kind, std::span<const Vec3>(at).first(cell.corners.size()));
  }
  bool is_valid_cell(std::int32_t c) const {
    const CellCorners& cell = cells_[static_cast<std::size_t>(c)];
    const auto at = corner_points(mesh_.points, cell.corners);
    return is_valid(cell.kind, std::span<const Vec3>(at).first(cell.corners.size()));
  }

  MixedMesh& mesh_;
  const GivenSurface& surface_;
  std::vector<CellCorners> cells_;
  VertexItems cells_at_;
  std::vector<VertexSurroundings> around_;
  FitCounts counts_;
};

}  // namespace

FitCounts fit_corners(MixedMesh& mesh, const GivenSurface& surface) {
  return CornerFitter(mesh, surface).run();
}

}  // namespace hexpipe::assemble::order
