#pragma once
// Where each vertex of the boundary belongs on the CAD: on a corner, a curve or a face of it.

#include <cstdint>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/fitcad/cad_shape.hpp"

namespace hexpipe::fitcad {

enum class Place : std::uint8_t { inside, face, curve, corner };

struct Target {
  Place place = Place::inside;
  Vec3 at;
};

// Vertices belong no further away than `reach` of the mean length of their facets' edges: a target that is further away
// is some other part of the CAD, and such a vertex belongs where it is, on `strays`.
struct Targets {
  std::vector<Target> of;  // by vertex
  std::vector<Vertex> strays;
  std::vector<double> lengths;                  // by vertex: the mean length of the edges of its facets
  std::vector<std::vector<std::int32_t>> tags;  // by vertex: those of its facets

  // The point near `to` that is on the same curve, or on the same faces, as the vertex's target. A corner stays.
  Vec3 slid(const CadShape& shape, Vertex v, const Vec3& to) const;
};

Targets find_targets(const MixedMesh& mesh, const CadShape& shape, double reach);

}  // namespace hexpipe::fitcad
