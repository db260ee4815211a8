#pragma once
// The point of a surface or of a curve that is nearest to a given one, by Newton's method from a start. Lengths are in
// the unit of the CAD.

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <array>
#include <gp_XYZ.hxx>

#include "common/mesh/vec3.hpp"

namespace hexpipe::fitcad {

inline Vec3 vec3_of(const gp_XYZ& p) {
  return {p.X(), p.Y(), p.Z()};
}

struct SurfacePlace {
  std::array<double, 2> parameters;  // u and v
  Vec3 at;
};

// A local minimum of the distance, near the start. Parameters stay within the surface's own bounds, unless it is
// periodic in that direction; the borders of a face on it do not count.
SurfacePlace nearest_on_surface(const BRepAdaptor_Surface& surface, const std::array<double, 2>& start, const Vec3& to);

// The same for a curve, between its ends.
Vec3 nearest_on_curve(const BRepAdaptor_Curve& curve, double start, const Vec3& to);

}  // namespace hexpipe::fitcad
