#include "common/mesh/face_measures.hpp"

#include <algorithm>
#include <cmath>

namespace hexpipe {
namespace {

// OpenFOAM's ROOTVSMALL and VSMALL: what is less counts as nothing.
constexpr double tiny = 1e-150, tiniest = 1e-300;

Vec3 mean_of(std::span<const Vec3> points) {
  Vec3 sum{};
  for (const Vec3& p : points) sum += p;
  return sum * (1.0 / static_cast<double>(points.size()));
}

// visit(corners) for the triangles, then the quads.
template <class Visit>
void for_each_face(CellKind kind, std::span<const Vec3> points, Visit&& visit) {
  auto each = [&](const auto& faces) {
    for (const auto& face : faces) {
      std::array<Vec3, 4> corners;
      for (std::size_t i = 0; i < face.size(); ++i) corners[i] = points[face[i]];
      visit(std::span<const Vec3>(corners).first(face.size()));
    }
  };
  with_topology(kind, [&](auto topology) {
    each(decltype(topology)::triangles);
    each(decltype(topology)::quads);
  });
}

}  // namespace

FaceShape face_shape(std::span<const Vec3> corners) {
  const Vec3 mean = mean_of(corners);
  if (corners.size() == 3) return {cross(corners[1] - corners[0], corners[2] - corners[0]) * 0.5, mean};
  FaceShape face;
  double size = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = corners[i], b = corners[(i + 1) % corners.size()];
    const Vec3 area = cross(b - a, mean - a) * 0.5;
    const double own = norm(area);
    face.area += area;
    face.centre += (a + b + mean) * (own / 3);
    size += own;
  }
  if (size < tiny) return {{}, mean};
  face.centre *= 1 / size;
  return face;
}

CellShape cell_shape(std::span<const FaceShape> faces) {
  Vec3 mean{};
  for (const FaceShape& face : faces) mean += face.centre;
  mean *= 1.0 / static_cast<double>(faces.size());
  Vec3 moment{};
  double volume = 0;
  for (const FaceShape& face : faces) {
    const double pyramid = dot(face.area, face.centre - mean);
    moment += (face.centre * 0.75 + mean * 0.25) * pyramid;
    volume += pyramid;
  }
  return {std::abs(volume) > tiniest ? moment * (1 / volume) : mean, volume / 3};
}

Vec3 cell_centre(CellKind kind, std::span<const Vec3> corners) {
  std::array<FaceShape, 6> faces;
  std::size_t count = 0;
  for_each_face(kind, corners, [&](std::span<const Vec3> face) { faces[count++] = face_shape(face); });
  return cell_shape(std::span(faces).first(count)).centre;
}

double orthogonality(const FaceShape& face, const Vec3& behind, const Vec3& before) {
  const Vec3 line = before - behind;
  return dot(line, face.area) / (norm(line) * norm(face.area) + tiny);
}

double face_weight(const FaceShape& face, const Vec3& behind, const Vec3& before) {
  const double one = std::abs(dot(face.area, face.centre - behind));
  const double two = std::abs(dot(face.area, before - face.centre));
  return std::min(one, two) / (one + two + tiniest);
}

double face_skewness(std::span<const Vec3> corners, const FaceShape& face, const Vec3& behind, const Vec3* before) {
  const Vec3 to_face = face.centre - behind;
  const Vec3 normal = face.area * (1 / (norm(face.area) + tiny));
  const Vec3 line = before != nullptr ? *before - behind : normal * dot(normal, to_face);
  const Vec3 miss = to_face - line * (dot(face.area, to_face) / (dot(face.area, line) + tiny));
  const Vec3 direction = miss * (1 / (norm(miss) + tiny));
  double width = (before != nullptr ? 0.2 : 0.4) * norm(line) + tiny;
  for (const Vec3& corner : corners) width = std::max(width, std::abs(dot(direction, corner - face.centre)));
  return norm(miss) / width;
}

double face_flatness(std::span<const Vec3> corners) {
  if (corners.size() == 3) return 1;
  const FaceShape face = face_shape(corners);
  const double size = norm(face.area);
  if (size < tiny) return 1;
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = corners[i], b = corners[(i + 1) % corners.size()];
    sum += 0.5 * norm(cross(b - a, face.centre - a));
  }
  return size / (sum + tiny);
}

double diagonal_sight(std::span<const Vec3> corners, const Vec3& behind, const Vec3& before) {
  const double size = std::sqrt(norm(face_shape(corners).area));
  if (size < tiny) return 0;
  double best = -1;
  for (std::size_t first = 0; first < 2; ++first) {
    double least = 1;
    for (const std::size_t from : {first, first + 2}) {
      const Vec3 a = corners[from], b = corners[(from + 1) % 4], c = corners[(from + 2) % 4];
      const Vec3 normal = cross(b - a, c - a);
      const double length = norm(normal) * size + tiny;
      least = std::min({least, dot(before - a, normal) / length, dot(a - behind, normal) / length});
    }
    best = std::max(best, least);
  }
  return best;
}

double cell_determinant(CellKind kind, std::span<const Vec3> corners, std::span<const std::uint8_t> inner) {
  std::array<Vec3, 6> areas;
  std::size_t count = 0, face_number = 0;
  for_each_face(kind, corners, [&](std::span<const Vec3> face) {
    if (inner[face_number++] != 0) areas[count++] = face_shape(face).area;
  });
  return cell_determinant(std::span(areas).first(count));
}

double cell_determinant(std::span<const Vec3> inner_areas) {
  double mean = 0;
  for (const Vec3& area : inner_areas) mean += norm(area);
  if (mean < tiny) return 0;
  mean /= static_cast<double>(inner_areas.size());
  std::array<Vec3, 3> rows{};
  for (const Vec3& area : inner_areas) {
    const Vec3 a = area * (1 / mean);
    rows[0] += a * a.x, rows[1] += a * a.y, rows[2] += a * a.z;
  }
  return std::abs(det(rows[0], rows[1], rows[2])) / 8;
}

bool is_convex(std::span<const FaceShape> faces) {
  constexpr double flat = 1e-6;  // a sine; OpenFOAM's planarCosAngle
  for (const FaceShape& face : faces) {
    const double size = norm(face.area);
    for (const FaceShape& other : faces) {
      if (&other == &face) continue;
      const Vec3 line = other.centre - face.centre;
      if (!(dot(line, face.area) < -flat * size * norm(line))) return false;
    }
  }
  return true;
}

}  // namespace hexpipe
