#pragma once
// The point of a surface or of a curve that is nearest to a given one, found downhill from a start.

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
  std::array<double, 2> parameters;
  Vec3 at;
};

// Parameters stay within the surface's own bounds, unless it is periodic there.
SurfacePlace nearest_on_surface(const BRepAdaptor_Surface& surface, const std::array<double, 2>& start, const Vec3& to);

// The curve's ends bound it.
Vec3 nearest_on_curve(const BRepAdaptor_Curve& curve, double start, const Vec3& to);

}  // namespace hexpipe::fitcad
