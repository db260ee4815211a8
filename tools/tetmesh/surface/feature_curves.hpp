#pragma once
// Feature curves, and vertices set along them: the segments between corners, and closed loops, get a whole number of
// steps of about the size.

#include <optional>
#include <span>
#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"

namespace hexpipe::tetmesh::surface {

struct FeatureCurve {
  std::vector<OpenMesh::VertexHandle> vertices;  // a closed one ends with its first
  bool closed = false;
};

// A curve as it is measured for sampling, maybe in finer segments than the mesh has.
struct MeasuredCurve {
  std::vector<Vec3> points;                      // a closed one ends with its first
  std::vector<OpenMesh::VertexHandle> vertices;  // at the points; invalid where the mesh has none
  std::vector<double> steps_per_size;            // wanted, of each segment
  bool closed = false;
  std::optional<int> steps = {};  // all together; nothing: as near to those wanted as a whole number is
};

// From corner to corner, then the loops without one; in the order of their first vertices.
std::vector<FeatureCurve> feature_curves(const FeatureMesh& mesh);

// Splits feature edges where a step ends and keeps these vertices. A curve bends away from its chords by at most
// `deviation`, for which it gets more steps where needed.
void sample_feature_curves(FeatureMesh& mesh, std::span<const MeasuredCurve> curves, const sizing::SizeField& size,
                           const sizing::SizeField& deviation);
// In even steps.
void sample_feature_curves(FeatureMesh& mesh, const sizing::SizeField& size, const sizing::SizeField& deviation);

}  // namespace hexpipe::tetmesh::surface
