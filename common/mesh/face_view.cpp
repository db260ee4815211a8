#include "common/mesh/face_view.hpp"

#include <algorithm>

namespace hexpipe {
namespace {

struct Face {
  Vec3 area;    // outward normal, as long as the face is large
  Vec3 centre;  // area-weighted mean of the triangles between the edges and the mean of the corners
};

template <class Corners>
Vec3 mean_of(std::span<const Vec3> points, const Corners& corners) {
  Vec3 sum{};
  for (const auto corner : corners) sum += points[corner];
  return (1.0 / static_cast<double>(corners.size())) * sum;
}

template <class Corners>
Face face_of(std::span<const Vec3> points, const Corners& corners) {
  const Vec3 mean = mean_of(points, corners);
  Face face{{}, {}};
  double size = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = points[corners[i]], b = points[corners[(i + 1) % corners.size()]];
    const Vec3 area = 0.5 * cross(a - mean, b - mean);
    face.area += area;
    face.centre += (norm(area) / 3) * (a + b + mean);
    size += norm(area);
  }
  face.centre = size > 0 ? (1 / size) * face.centre : mean;
  return face;
}

template <class Topology, class Visit>
void for_each_face(Visit&& visit) {
  for (const auto& triangle : Topology::triangles) visit(triangle);
  for (const auto& quad : Topology::quads) visit(quad);
}

template <class Topology>
double least_view_of(std::span<const Vec3> points) {
  Vec3 mean{};
  for (const Vec3& p : points) mean += p;
  mean = (1.0 / Topology::corner_count) * mean;

  double volume = 0;
  Vec3 moment{};
  for_each_face<Topology>([&](const auto& corners) {
    const Face face = face_of(points, corners);
    const double pyramid = dot(face.area, face.centre - mean) / 3;
    volume += pyramid;
    moment += pyramid * (0.75 * face.centre + 0.25 * mean);
  });
  const Vec3 mass = volume > 0 ? (1 / volume) * moment : mean;

  double least = 1;
  for_each_face<Topology>([&](const auto& corners) {
    const Vec3 area = face_of(points, corners).area;
    for (const auto corner : corners)
      for (const Vec3& centre : {mean, mass}) {
        const Vec3 view = points[corner] - centre;
        const double lengths = norm(area) * norm(view);
        least = std::min(least, lengths > 0 ? dot(area, view) / lengths : -1.0);
      }
  });
  return least;
}

}  // namespace

double least_face_view(CellKind kind, std::span<const Vec3> corners) {
  return with_topology(
      kind, [&]<class Topology>(Topology) { return least_view_of<Topology>(corners.first(Topology::corner_count)); });
}

}  // namespace hexpipe
