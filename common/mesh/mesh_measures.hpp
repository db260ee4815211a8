#pragma once
// How a whole mesh suits finite volumes: the measures of face_measures.hpp over its faces and cells.

#include <cstdint>
#include <numbers>
#include <vector>

#include "common/mesh/face_measures.hpp"
#include "common/mesh/mixed_mesh.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe {

inline constexpr double degree = std::numbers::pi / 180;

// By default those of OpenFOAM's checkMesh.
struct MeasureLimits {
  double angle = severe_angle;  // in radians, not more; the others are not less
  double weight = low_weight;
  double determinant = low_determinant;
  double flatness = low_flatness;
};

struct MeasureCount {
  std::int64_t misses = 0;  // faces beyond the limit; for the determinant, cells
  std::int64_t cells = 0;   // cells that have such a face
  double worst = 0;
  Vec3 place{};  // the centre of the face, or of the cell, that has the worst value
};

// Angle and weight are measured at inner faces, flatness at all faces. A face is inner if two cells have it with the
// same corners; so a quad that faces two triangles, in a mesh that does not conform, is not.
struct MeshMeasures {
  std::int64_t faces = 0, inner_faces = 0;
  double mean_angle = 0;  // in radians, of the mean cosine
  MeasureCount angle, weight, determinant, flatness;
};
MeshMeasures measure_mesh(const MixedMesh& mesh, const MeasureLimits& limits = {});

// The worst measures among the faces of each cell, in the order hexes, prisms, pyramids, tets.
struct MeasuresOfCells {
  std::vector<double> orthogonality, weight, determinant, flatness;
};
MeasuresOfCells measure_cells(const MixedMesh& mesh);

}  // namespace hexpipe
