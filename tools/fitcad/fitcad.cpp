#include "tools/fitcad/fitcad.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "common/mesh/quality.hpp"
#include "tools/fitcad/nearest_simplex.hpp"
#include "tools/fitcad/targets.hpp"

namespace hexpipe::fitcad {
namespace {

// Calls visit(points of the corners) for every facet of the boundary.
template <class Visit>
void for_each_facet(const MixedMesh& mesh, Visit&& visit) {
  const auto each = [&](const auto& block) {
    for (const auto& corners : block.cells) {
      std::vector<Vec3> points;
      for (const Vertex v : corners) points.push_back(mesh.points[v]);
      visit(points);
    }
  };
  each(mesh.triangles);
  each(mesh.quads);
}

Vec3 middle_of(const std::vector<Vec3>& points) {
  Vec3 sum;
  for (const Vec3& p : points) sum += p;
  return (1.0 / static_cast<double>(points.size())) * sum;
}

// The facets as triangles. A quad is bilinear; four triangles around its middle come near enough.
std::vector<Simplex> simplices_of_boundary(const MixedMesh& mesh) {
  std::vector<Simplex> simplices;
  for_each_facet(mesh, [&](const std::vector<Vec3>& points) {
    if (points.size() == 3) {
      simplices.push_back({points[0], points[1], points[2]});
      return;
    }
    const Vec3 middle = middle_of(points);
    for (std::size_t k = 0; k < points.size(); ++k)
      simplices.push_back({middle, points[k], points[(k + 1) % points.size()]});
  });
  return simplices;
}

// The distance of a vertex from the corner, the curve or the faces on which its target is.
double distance_to_place(const MixedMesh& mesh, const CadShape& shape, const Targets& targets, Vertex v) {
  const Vec3& p = mesh.points[v];
  return p == targets.of[v].at ? 0 : norm(p - targets.slid(shape, v, p));
}

BoundaryDistances distances(const MixedMesh& mesh, const CadShape& shape, const Targets& targets) {
  BoundaryDistances result;
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (targets.of[v].place != Place::inside)
      result.vertices = std::max(result.vertices, distance_to_place(mesh, shape, targets, static_cast<Vertex>(v)));
  for_each_facet(mesh, [&](const std::vector<Vec3>& points) {
    const double reach = 0.1 * norm(points[1] - points[0]);
    result.to_cad = std::max(result.to_cad, shape.on_faces(middle_of(points), reach).distance);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vec3 middle = 0.5 * (points[k] + points[(k + 1) % points.size()]);
      result.to_cad = std::max(result.to_cad, shape.on_faces(middle, reach).distance);
    }
  });
  const SimplexTree facets(simplices_of_boundary(mesh));
  for (const Vec3& p : shape.samples())
    result.from_cad = std::max(result.from_cad, facets.distance(p, std::numeric_limits<double>::infinity()));
  return result;
}

// Computes and stores the quality of every cell of a kind, and sums it up.
template <int N>
KindQuality measure(const MixedMesh& mesh, CellBlock<N>& block, CellKind kind) {
  KindQuality result{kind, static_cast<std::int64_t>(block.size())};
  block.quality.resize(block.size());
  for (std::size_t i = 0; i < block.size(); ++i) {
    const auto points = corner_points(mesh.points, block.cells[i]);
    const auto corners = std::span(points).template first<N>();
    const double quality = block.quality[i] = least_corner_scaled_jacobian(kind, corners);
    result.least = i == 0 ? quality : std::min(result.least, quality);
    result.mean += quality / static_cast<double>(block.size());
    result.volume += cell_volume(kind, corners);
  }
  return result;
}

std::array<KindQuality, 4> measure_cells(MixedMesh& mesh) {
  return {measure(mesh, mesh.hexes, CellKind::hex), measure(mesh, mesh.prisms, CellKind::prism),
          measure(mesh, mesh.pyramids, CellKind::pyramid), measure(mesh, mesh.tets, CellKind::tet)};
}

nlohmann::ordered_json to_json(const std::array<KindQuality, 4>& cells) {
  double volume = 0;
  std::int64_t count = 0;
  for (const KindQuality& of : cells) volume += of.volume, count += of.count;
  auto json = nlohmann::ordered_json::object();
  for (const KindQuality& of : cells)
    json[name_of(of.kind)] = {
        {"count", of.count},
        {"share_of_number", static_cast<double>(of.count) / static_cast<double>(std::max<std::int64_t>(count, 1))},
        {"share_of_volume", volume > 0 ? of.volume / volume : 0},
        {"scaled_jacobian", {{"least", of.least}, {"mean", of.mean}}}};
  return json;
}

nlohmann::ordered_json to_json(const BoundaryDistances& distances) {
  return {{"vertices", distances.vertices}, {"to_cad", distances.to_cad}, {"from_cad", distances.from_cad}};
}

}  // namespace

FitcadResult fit_to_cad(MixedMesh& mesh, const CadShape& shape, const FitcadOptions& options) {
  FitcadResult result;
  Targets targets = find_targets(mesh, shape, options.reach);
  result.strays = static_cast<std::int64_t>(targets.strays.size());
  for (const Target& target : targets.of) {
    result.boundary += target.place != Place::inside;
    result.on_curves += target.place == Place::curve;
    result.on_corners += target.place == Place::corner;
  }
  result.before = distances(mesh, shape, targets);
  result.counts = move_boundary(mesh, shape, targets);
  result.cells = measure_cells(mesh);
  result.after = distances(mesh, shape, targets);
  result.diagonal = shape.diagonal();
  return result;
}

nlohmann::ordered_json to_json(const FitcadResult& result) {
  return {{"cells", to_json(result.cells)},
          {"boundary", {{"greatest_deviation", std::max(result.after.to_cad, result.after.from_cad)}}},
          {"boundary_vertices", result.boundary},
          {"on_curves", result.on_curves},
          {"on_corners", result.on_corners},
          {"moved", result.counts.moved},
          {"moved_inside", result.counts.inside},
          {"slid", result.counts.slid},
          {"held", result.counts.held},
          {"poorer_cells", result.counts.poorer},
          {"strays", result.strays},
          {"diagonal", result.diagonal},
          {"distance_before", to_json(result.before)},
          {"distance", to_json(result.after)}};
}

}  // namespace hexpipe::fitcad
