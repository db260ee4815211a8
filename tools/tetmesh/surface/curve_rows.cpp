#include "tools/tetmesh/surface/curve_rows.hpp"

#include <algorithm>

#include "tools/tetmesh/surface/surface_curl.hpp"
#include "tools/tetmesh/surface/surface_refine.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

using Vertex = OpenMesh::VertexHandle;

// Steps are longer or shorter than the size by at most this factor.
constexpr double most_stretch = 1.5;

class CurveMeasurer {
 public:
  CurveMeasurer(const FeatureMesh& refined, std::size_t own_vertices, const sizing::SizeField& size)
      : mesh_(refined), own_vertices_(own_vertices), size_(size), steps_(steps(refined, size)) {}

  MeasuredCurve measure(const FeatureCurve& curve) const {
    MeasuredCurve result;
    result.closed = curve.closed;
    for (const Vertex v : curve.vertices) {
      const bool own = static_cast<std::size_t>(v.idx()) < own_vertices_;
      result.points.push_back(mesh_.position(v));
      result.vertices.push_back(own ? v : Vertex());
    }
    const std::vector<double> at = steps_per_size_at(curve);
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      const double known = static_cast<double>(at[i] > 0) + static_cast<double>(at[i + 1] > 0);
      result.steps_per_size.push_back(known > 0 ? (at[i] + at[i + 1]) / known : 1);
    }
    return result;
  }

 private:
  static std::vector<double> steps(const FeatureMesh& mesh, const sizing::SizeField& size) {
    const FieldSurface surface(mesh, size);
    // Whether opposite sides agree makes no difference to the number of rows: 93.0 or 93.1 % in hexes on five models.
    const CrossField field = cross_field(surface);
    return steps_along_features({surface, field});
  }

  // By vertex; 0 where it is not known.
  std::vector<double> steps_per_size_at(const FeatureCurve& curve) const {
    const std::size_t count = curve.vertices.size() - 1;
    std::vector<double> result(count + 1);
    for (std::size_t i = curve.closed ? 0 : 1; i < count; ++i)
      result[i] = steps_per_size(curve.vertices[i > 0 ? i - 1 : count - 1], curve.vertices[i], curve.vertices[i + 1]);
    if (curve.closed) result[count] = result[0];
    return result;
  }

  // The mean of both sides of the curve, from the middle of one edge to the middle of the other.
  double steps_per_size(Vertex before, Vertex v, Vertex after) const {
    const Vec3 p = mesh_.position(v);
    const double sizes = 0.5 * (norm(mesh_.position(before) - p) + norm(mesh_.position(after) - p)) / size_.at(p);
    double sum = 0, count = 0;
    for (const Vertex to : {before, after}) {
      const double steps = steps_[half_edge_of(mesh_, mesh_.find_halfedge(v, to))];
      if (!(steps > 0)) continue;
      sum += steps / sizes;
      ++count;
    }
    return count > 0 ? std::clamp(sum / count, 1 / most_stretch, most_stretch) : 0;
  }

  const FeatureMesh& mesh_;
  std::size_t own_vertices_;  // the number of vertices that the mesh had before it was refined
  const sizing::SizeField& size_;
  std::vector<double> steps_;  // by half-edge
};

}  // namespace

std::vector<MeasuredCurve> curves_by_rows(const FeatureMesh& mesh, const sizing::SizeField& size,
                                          const sizing::SizeField& longest, const sizing::SizeField& flatness) {
  FeatureMesh refined = mesh;
  refine_surface(refined, longest, flatness);
  const CurveMeasurer measurer(refined, mesh.n_vertices(), size);
  std::vector<MeasuredCurve> result;
  for (const FeatureCurve& curve : feature_curves(refined)) result.push_back(measurer.measure(curve));
  return result;
}

}  // namespace hexpipe::tetmesh::surface
