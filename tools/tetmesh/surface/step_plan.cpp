// QuadriFlow (Huang, Zhou, Niessner, Shewchuk, Guibas 2018) asks for sums of zero around each triangle, of a surface
// whose features it does not know. Around whole faces the same sums are a few equations between the numbers of steps of
// the curves beside them.

#include "tools/tetmesh/surface/step_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "tools/tetmesh/fields/whole_number_program.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

using geometry::HalfEdge;

// A curve's part in a sum around a face, if it is nearer than that to a whole one.
constexpr double whole_tolerance = 0.1;
// By how much a curve's number of steps may differ from what is wanted, as a factor.
constexpr double most_change = 1.35;
// Its steps are longer or shorter than the size by that factor at most.
constexpr double most_stretch = 1.5;
// Steps by which a number may differ in any case.
constexpr double rounding = 0.5;
constexpr int least_open = 1, least_closed = 4;

using Equation = fields::WholeEquation;

// The faces between features, with two directions that are the same all over each of them where that is possible.
class FaceFinder {
 public:
  explicit FaceFinder(const SurfaceLinks& links) : links_(links), face_of_(links.surface.triangles.size(), no_index) {
    axes_.resize(face_of_.size());
    for (std::int32_t f = 0; f < static_cast<std::int32_t>(face_of_.size()); ++f)
      if (face_of_[f] == no_index) flood(f);
    check();
  }

  std::size_t count() const { return is_regular_.size(); }
  std::int32_t face_of(std::int32_t triangle) const { return face_of_[triangle]; }
  bool is_regular(std::int32_t face) const { return is_regular_[face]; }
  // Direction 0 or 1 of the face, and whether it is turned round, as that of a triangle.
  FollowedAxis of_face(std::int32_t triangle, const FollowedAxis& along) const {
    const auto& [first, second] = axes_[triangle];
    const FollowedAxis& same = first.axis == along.axis ? first : second;
    return {first.axis == along.axis ? std::size_t{0} : 1, same.flipped != along.flipped};
  }

 private:
  void flood(std::int32_t seed) {
    const auto face = static_cast<std::int32_t>(is_regular_.size());
    is_regular_.push_back(true);
    face_of_[seed] = face;
    axes_[seed] = {FollowedAxis{0}, FollowedAxis{1}};
    std::vector<std::int32_t> queue{seed};
    for (std::size_t i = 0; i < queue.size(); ++i)
      for (HalfEdge h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
        const std::int32_t beyond = links_.of[h].neighbour;
        if (beyond == no_index || face_of_[beyond] != no_index) continue;
        face_of_[beyond] = face;
        axes_[beyond] = axes_[queue[i]];
        for (FollowedAxis& axis : axes_[beyond]) axis.cross(links_, h);
        queue.push_back(beyond);
      }
  }

  void check() {
    links_.for_each_pair([&](HalfEdge h) {
      const std::int32_t f = geometry::triangle_of(h);
      FollowedAxis first = axes_[f][0];
      first.cross(links_, h);
      const FollowedAxis& there = axes_[links_.of[h].neighbour][0];
      if (links_.of[h].weight <= 0 || first.axis != there.axis || first.flipped != there.flipped)
        is_regular_[face_of_[f]] = false;
    });
  }

  const SurfaceLinks& links_;
  std::vector<std::int32_t> face_of_;
  std::vector<std::array<FollowedAxis, 2>> axes_;  // of each triangle, that are those of its face
  std::vector<bool> is_regular_;
};

class EquationFinder {
 public:
  EquationFinder(const SurfaceLinks& links, std::span<const CurveDemand> curves, const CurveOfHalfEdge& curve_of)
      : links_(links), curves_(curves), curve_of_(curve_of), faces_(links) {}

  // Unknowns beyond those of the curves are half the sums around faces with singularities.
  std::vector<Equation> find() {
    sums_.resize(2 * faces_.count());
    ends_.resize(faces_.count());
    for (HalfEdge h = 0; h < static_cast<HalfEdge>(curve_of_.size()); ++h)
      if (curve_of_[h] != no_index) add(h);
    std::vector<Equation> equations;
    auto unknowns = static_cast<std::int32_t>(curves_.size());
    for (std::int32_t face = 0; face < static_cast<std::int32_t>(faces_.count()); ++face) {
      const auto first = whole(sums_[2 * face]), second = whole(sums_[2 * face + 1]);
      if (faces_.is_regular(face) && first && second) {
        equations.push_back(*first);
        equations.push_back(*second);
      } else if (auto all = whole(ends_[face])) {
        (*all)[unknowns++] = -2;
        equations.push_back(*all);
      }
    }
    return equations;
  }

 private:
  using RealSum = std::map<std::int32_t, double>;

  void add(HalfEdge h) {
    const std::int32_t f = geometry::triangle_of(h), face = faces_.face_of(f), curve = curve_of_[h];
    const Vec3 edge = links_.surface.edge_vector(h);
    const double part = norm(edge) / curves_[curve].length;
    ends_[face][curve] += part;
    const FollowedAxis along = FollowedAxis::nearest(links_, f, edge);
    if (dot(along.in(links_, f), unit(edge)) < aligned_cosine) return;
    const FollowedAxis known = faces_.of_face(f, along);
    sums_[2 * face + static_cast<std::int32_t>(known.axis)][curve] += known.flipped ? -part : part;
  }

  static std::optional<Equation> whole(const RealSum& sum) {
    Equation equation;
    for (const auto& [curve, part] : sum) {
      const double rounded = std::round(part);
      if (std::abs(part - rounded) > whole_tolerance) return std::nullopt;
      if (rounded != 0) equation[curve] = static_cast<std::int32_t>(rounded);
    }
    return equation;
  }

  const SurfaceLinks& links_;
  std::span<const CurveDemand> curves_;
  const CurveOfHalfEdge& curve_of_;
  FaceFinder faces_;
  std::vector<RealSum> sums_;  // two of each face: curves' parts along each direction
  std::vector<RealSum> ends_;  // of each face: how often each curve is beside it
};

class StepPlanner {
 public:
  StepPlanner(const SurfaceLinks& links, std::span<const CurveDemand> curves, const CurveOfHalfEdge& curve_of)
      : curves_(curves), program_(program_of(links, curves, curve_of)) {}

  std::vector<int> plan() {
    auto best = program_.relax();
    while (best) {
      const std::int32_t worst = worst_changed(*best);
      if (worst < 0 || !program_.drop_worst_of(worst)) break;
      best = program_.relax();
    }
    std::vector<std::int32_t> planned;
    if (best) {
      planned = program_.round();
    } else {
      for (const CurveDemand& curve : curves_)
        planned.push_back(static_cast<std::int32_t>(std::lround(curve.steps / unit_of(curve))));
    }
    std::vector<int> result;
    for (std::size_t i = 0; i < curves_.size(); ++i)
      result.push_back(std::max(curves_[i].closed ? least_closed : least_open, unit_of(curves_[i]) * planned[i]));
    return result;
  }

 private:
  // Steps that its unknown counts: of a closed curve pairs, so that it has an even number of them.
  static int unit_of(const CurveDemand& curve) { return curve.closed ? 2 : 1; }

  static fields::WholeNumberProgram program_of(const SurfaceLinks& links, std::span<const CurveDemand> curves,
                                               const CurveOfHalfEdge& curve_of) {
    std::vector<Equation> equations = EquationFinder(links, curves, curve_of).find();
    for (Equation& equation : equations)
      for (auto& [unknown, factor] : equation)
        if (unknown < static_cast<std::int32_t>(curves.size())) factor *= unit_of(curves[unknown]);
    std::vector<double> wanted, weights;
    for (const CurveDemand& curve : curves) {
      const double unit = unit_of(curve);
      wanted.push_back(curve.steps / unit);
      weights.push_back(unit * unit / std::max(curve.steps, 1.0));
    }
    return {std::move(equations), std::move(wanted), std::move(weights)};
  }

  // The curve whose steps are furthest beyond what they may be, or no_index.
  std::int32_t worst_changed(const std::vector<double>& values) const {
    std::int32_t worst = no_index;
    double most = 1;
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      const double change = change_of(curves_[i], unit_of(curves_[i]) * values[i]);
      if (change <= most) continue;
      most = change;
      worst = static_cast<std::int32_t>(i);
    }
    return worst;
  }

  // Above 1: more than it may be.
  static double change_of(const CurveDemand& curve, double steps) {
    if (std::abs(steps - curve.steps) < rounding) return 0;
    if (steps <= 0) return HUGE_VAL;
    return std::max(std::abs(std::log(steps / curve.steps)) / std::log(most_change),
                    std::abs(std::log(steps / curve.sizes)) / std::log(most_stretch));
  }

  std::span<const CurveDemand> curves_;
  fields::WholeNumberProgram program_;
};

}  // namespace

std::vector<int> plan_steps(const SurfaceLinks& links, std::span<const CurveDemand> curves,
                            const CurveOfHalfEdge& curve_of) {
  return StepPlanner(links, curves, curve_of).plan();
}

}  // namespace hexpipe::tetmesh::surface
