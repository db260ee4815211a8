#pragma once
// Feature curves, and the vertices set along them: segments between corners, and closed loops, get a whole number of
// steps of about one size.

#include <optional>
#include <span>
#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"

namespace hexpipe::tetmesh::surface {

struct FeatureCurve {
  std::vector<OpenMesh::VertexHandle> vertices;  // a closed curve ends with its first vertex
  bool closed = false;
};

// A curve as it is measured for sampling; its segments may be finer than those of the mesh.
struct MeasuredCurve {
  std::vector<Vec3> points;                      // a closed curve ends with its first point
  std::vector<OpenMesh::VertexHandle> vertices;  // at the points; invalid where the mesh has no vertex
  std::vector<double> steps_per_size;            // the number that is wanted, for each segment
  bool closed = false;
  std::optional<int> steps = {};  // all together; nothing: as near to those wanted as a whole number is
};

// Curves from corner to corner come first, then loops without a corner, both in the order of their first vertices. A
// curve of joints comes once, with vertices of one of the sheets that meet in it.
std::vector<FeatureCurve> feature_curves(const FeatureMesh& mesh);

// Splits feature edges where a step ends, and keeps these vertices. If a curve bends away from its chords by more than
// `deviation`, it gets more steps.
void sample_feature_curves(FeatureMesh& mesh, std::span<const MeasuredCurve> curves, const sizing::SizeField& size,
                           const sizing::SizeField& deviation);
// The same with even steps.
void sample_feature_curves(FeatureMesh& mesh, const sizing::SizeField& size, const sizing::SizeField& deviation);

}  // namespace hexpipe::tetmesh::surface
