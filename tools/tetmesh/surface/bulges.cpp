#include "tools/tetmesh/surface/bulges.hpp"

#include <algorithm>
#include <cmath>

#include "tools/tetmesh/geometry/sized_point_grid.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// Faces that were too far come as near as this share of the deviation.
constexpr double aim = 0.9;
// A face may turn by an angle of this cosine: less than makes a feature.
constexpr double least_cosine = 0.82;

// How far the original surface is, at most, on the two sides of faces.
struct Distances {
  double above = 0, below = 0;
  void include(const Distances& other) {
    above = std::max(above, other.above);
    below = std::max(below, other.below);
  }
};

Distances distances_from(const std::array<Vec3, 3>& face, std::span<const Vec3> points) {
  const geometry::TriangleDistance triangle(face[0], face[1], face[2]);
  Distances found;
  for (const Vec3& p : points) {
    double& side = dot(p - face[0], triangle.normal()) > 0 ? found.above : found.below;
    side = std::max(side, std::sqrt(triangle.squared(p)));
  }
  return found;
}

// How far a vertex moves to where its faces are too far from the original surface; negative: downwards. Not so far that
// they are too far on the other side.
double step_for(const Distances& around, double deviation) {
  const auto [least, greatest] = std::minmax(around.above, around.below);
  if (greatest <= deviation) return 0;
  const double length = std::max(0.0, std::min(greatest - aim * deviation, aim * deviation - least));
  return around.above > around.below ? length : -length;
}

bool turns(const std::array<Vec3, 3>& before, const std::array<Vec3, 3>& after) {
  const Vec3 was = cross(before[1] - before[0], before[2] - before[0]),
             is = cross(after[1] - after[0], after[2] - after[0]);
  return dot(was, is) < least_cosine * norm(was) * norm(is);
}

}  // namespace

FirmVertices::FirmVertices(const FeatureMesh& mesh, std::span<const std::vector<Vec3>* const> faults,
                           const sizing::SizeField& reach)
    : is_firm_(mesh.n_vertices()) {
  geometry::SizedPointGrid places(mesh.n_vertices() == 0 ? Vec3{} : mesh.position(VertexH(0)));
  for (const std::vector<Vec3>* some : faults)
    for (const Vec3& p : *some) places.add(p, reach.at(p));
  for (const VertexH v : mesh.vertices()) {
    bool is_firm = mesh.is_on_feature(v) || mesh.has_copies(v);
    if (!is_firm && !places.points().empty()) {
      const Vec3 here = mesh.position(v);
      const double length = reach.at(here);
      places.for_each_near(here, length, 0, [&](std::int32_t i) {
        is_firm = norm_squared(places.points()[i] - here) <= length * length;
        return !is_firm;
      });
    }
    is_firm_[v.idx()] = is_firm;
  }
  for (const FaceH f : mesh.faces())
    if (mesh.is_held(f))
      for (const VertexH v : mesh.corners(f)) is_firm_[v.idx()] = true;
}

void step_out(FeatureMesh& mesh, std::span<const std::vector<Vec3>> points, const FirmVertices& firm,
              const sizing::SizeField& deviation) {
  std::vector<Distances> around(mesh.n_vertices());
  for (const FaceH f : mesh.faces()) {
    const Distances of_face = distances_from(mesh.positions(f), points[f.idx()]);
    for (const VertexH v : mesh.corners(f)) around[v.idx()].include(of_face);
  }
  std::vector<Vec3> places(mesh.n_vertices());
  for (const VertexH v : mesh.vertices()) {
    const Vec3 here = places[v.idx()] = mesh.position(v);
    const double step = firm.has(v) ? 0 : step_for(around[v.idx()], deviation.at(here));
    if (step == 0) continue;
    Vec3 normal{};
    for (const FaceH f : mesh.vf_range(v)) normal = normal + mesh.area_normal(f);
    if (norm(normal) > 0) places[v.idx()] = here + step * unit(normal);
  }
  // A vertex that stays after all may make another face turn.
  for (bool is_final = false; !is_final;) {
    is_final = true;
    for (const FaceH f : mesh.faces()) {
      const auto [a, b, c] = mesh.corners(f);
      if (!turns(mesh.positions(f), {places[a.idx()], places[b.idx()], places[c.idx()]})) continue;
      for (const VertexH v : {a, b, c}) {
        is_final = is_final && places[v.idx()] == mesh.position(v);
        places[v.idx()] = mesh.position(v);
      }
    }
  }
  for (const VertexH v : mesh.vertices()) mesh.set_point(v, to_open_mesh(places[v.idx()]));
}

}  // namespace hexpipe::tetmesh::surface
