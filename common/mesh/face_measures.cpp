#include "common/mesh/face_measures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/quality.hpp"

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

// visit(kind, corners) for each cell.
template <class Visit>
void for_each_cell(const MixedMesh& mesh, Visit&& visit) {
  for (const auto& cell : mesh.hexes.cells) visit(CellKind::hex, std::span<const Vertex>(cell));
  for (const auto& cell : mesh.prisms.cells) visit(CellKind::prism, std::span<const Vertex>(cell));
  for (const auto& cell : mesh.pyramids.cells) visit(CellKind::pyramid, std::span<const Vertex>(cell));
  for (const auto& cell : mesh.tets.cells) visit(CellKind::tet, std::span<const Vertex>(cell));
}

// One side of a face. The keys of triangles end in -1, which no vertex is.
struct Side {
  VertexKey<4> key;
  Quad corners;
  std::int64_t cell;
};

std::vector<Side> sides_of(const MixedMesh& mesh) {
  std::vector<Side> sides;
  std::int64_t cell = 0;
  for_each_cell(mesh, [&](CellKind kind, std::span<const Vertex> corners) {
    auto each = [&](const auto& faces) {
      for (const auto& face : faces) {
        Quad own{-1, -1, -1, -1};
        for (std::size_t i = 0; i < face.size(); ++i) own[i] = corners[face[i]];
        sides.push_back({key_of(own), own, cell});
      }
    };
    with_topology(kind, [&](auto topology) {
      each(decltype(topology)::triangles);
      each(decltype(topology)::quads);
    });
    ++cell;
  });
  std::ranges::sort(sides,
                    [](const Side& a, const Side& b) { return a.key != b.key ? a.key < b.key : a.cell < b.cell; });
  return sides;
}

FaceShape shape_of(const std::vector<Vec3>& points, const Quad& corners) {
  const std::size_t count = corners[3] < 0 ? 3 : 4;
  const auto at = corner_points(points, std::span(corners).first(count));
  return face_shape(std::span<const Vec3>(at).first(count));
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

Vec3 cell_centre(CellKind kind, std::span<const Vec3> corners) {
  std::array<FaceShape, 6> faces;
  std::size_t count = 0;
  Vec3 mean{};
  for_each_face(kind, corners, [&](std::span<const Vec3> face) {
    faces[count] = face_shape(face);
    mean += faces[count++].centre;
  });
  mean *= 1.0 / static_cast<double>(count);
  Vec3 moment{};
  double volume = 0;
  for (const FaceShape& face : std::span(faces).first(count)) {
    const double pyramid = dot(face.area, face.centre - mean);
    moment += (face.centre * 0.75 + mean * 0.25) * pyramid;
    volume += pyramid;
  }
  return std::abs(volume) > tiniest ? moment * (1 / volume) : mean;
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

double cell_determinant(CellKind kind, std::span<const Vec3> corners, std::span<const std::uint8_t> inner) {
  std::array<Vec3, 6> areas;
  std::size_t count = 0, face_number = 0;
  double mean = 0;
  for_each_face(kind, corners, [&](std::span<const Vec3> face) {
    if (inner[face_number++] == 0) return;
    areas[count] = face_shape(face).area;
    mean += norm(areas[count++]);
  });
  if (count == 0 || mean < tiny) return 0;
  mean /= static_cast<double>(count);
  std::array<Vec3, 3> rows{};
  for (const Vec3& area : std::span(areas).first(count)) {
    const Vec3 a = area * (1 / mean);
    rows[0] += a * a.x, rows[1] += a * a.y, rows[2] += a * a.z;
  }
  return std::abs(det(rows[0], rows[1], rows[2])) / 8;
}

FaceStatistics face_statistics(const MixedMesh& mesh) {
  std::vector<Vec3> centres;
  centres.reserve(mesh.cell_count());
  for_each_cell(mesh, [&](CellKind kind, std::span<const Vertex> corners) {
    const auto at = corner_points(mesh.points, corners);
    centres.push_back(cell_centre(kind, std::span<const Vec3>(at).first(corners.size())));
  });
  const std::vector<Side> sides = sides_of(mesh);
  FaceStatistics result;
  double least_cosine = 1, sum = 0;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    if (sides[i].key != sides[i + 1].key) continue;
    const FaceShape face = shape_of(mesh.points, sides[i].corners);
    const Vec3 &behind = centres[sides[i].cell], &before = centres[sides[i + 1].cell];
    const double cosine = orthogonality(face, behind, before), weight = face_weight(face, behind, before);
    ++result.faces;
    result.severe += cosine < std::cos(severe_angle) ? 1 : 0;
    result.low += weight < low_weight ? 1 : 0;
    least_cosine = std::min(least_cosine, cosine);
    sum += cosine;
    result.least_weight = std::min(result.least_weight, weight);
  }
  if (result.faces == 0) return result;
  result.most_angle = std::acos(std::clamp(least_cosine, -1.0, 1.0));
  result.mean_angle = std::acos(std::clamp(sum / static_cast<double>(result.faces), -1.0, 1.0));
  return result;
}

}  // namespace hexpipe
