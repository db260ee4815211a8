#include "tools/fitcad/newton.hpp"

#include <algorithm>
#include <cmath>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

namespace hexpipe::fitcad {
namespace {

constexpr int most_steps = 40, most_halvings = 30;
// Steps that move the point by less than this share of its distance from the origin and of the surface's extent change
// nothing any more.
constexpr double least_step = 1e-15;

struct Interval {
  double from, to;
  bool periodic;

  double clamped(double parameter) const { return periodic ? parameter : std::clamp(parameter, from, to); }
};

// Takes steps downhill. `step_at(parameters)` is a step towards the minimum and how far it moves the point;
// `square_at(parameters)` is the squared distance.
template <class Parameters, class StepAt, class SquareAt, class Bounded>
Parameters descend(Parameters at, StepAt&& step_at, SquareAt&& square_at, Bounded&& bounded, double scale) {
  double square = square_at(at);
  for (int i = 0; i < most_steps; ++i) {
    const auto [step, length] = step_at(at);
    if (!(length > least_step * scale)) return at;
    double share = 1;
    bool is_better = false;
    for (int k = 0; k < most_halvings && !is_better; ++k, share /= 2) {
      const Parameters next = bounded(at, step, share);
      const double next_square = square_at(next);
      if (!(next_square < square)) continue;
      is_better = true;
      at = next;
      square = next_square;
    }
    if (!is_better) return at;
  }
  return at;
}

}  // namespace

SurfacePlace nearest_on_surface(const BRepAdaptor_Surface& surface, const std::array<double, 2>& start,
                                const Vec3& to) {
  using Parameters = std::array<double, 2>;
  const Interval u{surface.FirstUParameter(), surface.LastUParameter(), surface.IsUPeriodic() == Standard_True};
  const Interval v{surface.FirstVParameter(), surface.LastVParameter(), surface.IsVPeriodic() == Standard_True};
  const auto point_at = [&](const Parameters& p) { return vec3_of(surface.Value(p[0], p[1]).XYZ()); };
  struct Step {
    Parameters step;
    double length;
  };
  const auto step_at = [&](const Parameters& p) {
    gp_Pnt point;
    gp_Vec du, dv, duu, dvv, duv;
    surface.D2(p[0], p[1], point, du, dv, duu, dvv, duv);
    const Vec3 r = vec3_of(point.XYZ()) - to, su = vec3_of(du.XYZ()), sv = vec3_of(dv.XYZ());
    const double gu = dot(r, su), gv = dot(r, sv);
    double a = dot(su, su) + dot(r, vec3_of(duu.XYZ())), b = dot(su, sv) + dot(r, vec3_of(duv.XYZ())),
           c = dot(sv, sv) + dot(r, vec3_of(dvv.XYZ()));
    // Where the distance curves downward, the surface is taken to be flat. At poles one of the tangents vanishes.
    if (!(a > 0 && a * c - b * b > 1e-12 * a * c)) {
      const double damping = 1e-9 * (norm_squared(su) + norm_squared(sv)) + 1e-300;
      a = norm_squared(su) + damping, b = dot(su, sv), c = norm_squared(sv) + damping;
    }
    const double determinant = a * c - b * b;
    const Parameters step{-(c * gu - b * gv) / determinant, -(a * gv - b * gu) / determinant};
    return Step{step, norm(step[0] * su + step[1] * sv)};
  };
  const auto bounded = [&](const Parameters& at, const Parameters& step, double share) {
    return Parameters{u.clamped(at[0] + share * step[0]), v.clamped(at[1] + share * step[1])};
  };
  const Parameters begin{u.clamped(start[0]), v.clamped(start[1])};
  const Parameters best = descend(
      begin, step_at, [&](const Parameters& p) { return norm_squared(point_at(p) - to); }, bounded,
      norm(to) + norm(point_at(begin) - to));
  return {best, point_at(best)};
}

Vec3 nearest_on_curve(const BRepAdaptor_Curve& curve, double start, const Vec3& to) {
  const Interval t{curve.FirstParameter(), curve.LastParameter(), false};
  const auto point_at = [&](double p) { return vec3_of(curve.Value(p).XYZ()); };
  struct Step {
    double step;
    double length;
  };
  const auto step_at = [&](double p) {
    gp_Pnt point;
    gp_Vec first, second;
    curve.D2(p, point, first, second);
    const Vec3 r = vec3_of(point.XYZ()) - to, tangent = vec3_of(first.XYZ());
    const double flat = norm_squared(tangent) + 1e-300;
    const double curved = flat + dot(r, vec3_of(second.XYZ()));
    const double step = -dot(r, tangent) / (curved > 0.01 * flat ? curved : flat);
    return Step{step, std::abs(step) * norm(tangent)};
  };
  const double begin = t.clamped(start);
  const double best = descend(
      begin, step_at, [&](double p) { return norm_squared(point_at(p) - to); },
      [&](double at, double step, double share) { return t.clamped(at + share * step); },
      norm(to) + norm(point_at(begin) - to));
  return point_at(best);
}

}  // namespace hexpipe::fitcad
