#pragma once
// Where each vertex of the boundary belongs on the CAD: on a corner, a curve or a face of it.

#include <cstdint>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/fitcad/cad_shape.hpp"

namespace hexpipe::fitcad {

enum class Place : std::uint8_t { inside, face, curve, corner };  // inside: the vertex is not on the boundary

struct Target {
  Place place = Place::inside;
  Vec3 at;                 // where the vertex is to go; without meaning inside
  bool may_leave = false;  // a curve: the vertex is on no edge between tags, so one of the faces will do
};

struct Targets {
  std::vector<Target> of;                       // by vertex
  std::vector<Vertex> strays;                   // vertices whose target is too far away; they stay where they are
  std::vector<double> lengths;                  // by vertex: the mean length of the edges of its facets
  std::vector<std::vector<std::int32_t>> tags;  // by vertex: those of its facets

  // The nearest point of the faces with the tags of a vertex.
  Vec3 on_face(const CadShape& shape, Vertex v, const Vec3& to) const;
  // Where a vertex goes on the CAD if it slides towards `to`: the nearest point of the curves, or of the faces with its
  // tags. A vertex with a corner as its target does not slide.
  Vec3 slid(const CadShape& shape, Vertex v, const Vec3& to) const;
};

// A vertex whose target would be further away than `reach` times its length becomes a stray: what is found there is
// some other part of the CAD.
Targets find_targets(const MixedMesh& mesh, const CadShape& shape, double reach);

}  // namespace hexpipe::fitcad
