// Places a vertex so that the worst element around it becomes as good as it can: steepest ascent of a minimum of smooth
// functions, along the shortest vector in the convex hull of the gradients of the functions that are nearly least, with
// the first step taken from the linear models and halved until the minimum rises.
// L. A. Freitag, M. Jones, P. Plassmann, "An efficient parallel algorithm for mesh smoothing" (1995), section 3, and
// L. A. Freitag, C. Ollivier-Gooch, "Tetrahedral mesh improvement using swapping and smoothing" (1997), section 3.
// Their quadratic program for the direction is replaced by Gilbert's iteration, which needs no factorization, and the
// width of the active set shrinks when no step succeeds.

#include "tools/assemble/shape/point_star.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hexpipe::assemble::shape {
namespace {

// Without this factor the scaled Jacobian of a tet is at most sqrt(1/2).
const double tet_scale = std::sqrt(2.0);

// At first, corners within this distance of the worst decide the direction.
constexpr double widest_band = 0.1;
constexpr double narrowest_band = 1e-3;
// A gain below this is not worth another step.
constexpr double least_gain = 1e-5;
constexpr int halvings = 5;
// The first step is long enough to raise the score by this, by its linear model.
constexpr double first_rise = 0.2;

double product_of_norms(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::sqrt(norm_squared(a) * norm_squared(b) * norm_squared(c));
}

}  // namespace

void PointStar::add(CellKind kind, std::span<const Vec3> corners, int moving, const CornerRules& rules) {
  Term term{};
  term.scale = kind == CellKind::tet ? rules.weight * tet_scale : rules.weight;
  term.rules = rules;
  term.mean_share = 1 / (rules.weight * rules.weight);
  with_topology(kind, [&](auto topology) {
    for (const auto& corner : decltype(topology)::corners) add_corner(corners, corner, moving, term);
  });
}

void PointStar::add_corner(std::span<const Vec3> corners, const LocalCorner& corner, int moving, const Term& model) {
  Term term = model;
  if (corner[0] == moving) {
    term.fixed = {corners[corner[1]], corners[corner[2]], corners[corner[3]]};
    term.is_corner = true;
    terms_.push_back(term);
    return;
  }
  for (int i = 1; i < 4; ++i) {
    if (corner[i] != moving) continue;
    const Vec3 o = corners[corner[0]];
    const Vec3 b = corners[corner[i % 3 + 1]] - o, c = corners[corner[(i + 1) % 3 + 1]] - o;
    const double lengths = std::sqrt(norm_squared(b) * norm_squared(c));
    term.fixed[0] = o;
    term.normal = cross(b, c) * (lengths > 0 ? 1 / lengths : 0);
    terms_.push_back(term);
  }
}

double PointStar::value(std::size_t term, const Vec3& at) const {
  const Term& t = terms_[term];
  if (t.is_corner) {
    const Vec3 a = t.fixed[0] - at, b = t.fixed[1] - at, c = t.fixed[2] - at;
    const double lengths = product_of_norms(a, b, c);
    return lengths > 0 ? t.scale * det(a, b, c) / lengths : 0;
  }
  const Vec3 a = at - t.fixed[0];
  const double length = norm(a);
  return length > 0 ? t.scale * dot(a, t.normal) / length : 0;
}

Vec3 PointStar::gradient(std::size_t term, const Vec3& at) const {
  const Term& t = terms_[term];
  if (!t.is_corner) {
    const Vec3 a = at - t.fixed[0];
    const double length = norm(a);
    if (length == 0) return t.scale * t.normal;
    return (t.scale / length) * (t.normal - a * (dot(a, t.normal) / (length * length)));
  }
  const Vec3 a = t.fixed[0] - at, b = t.fixed[1] - at, c = t.fixed[2] - at;
  const double lengths = product_of_norms(a, b, c);
  if (lengths == 0) return {};
  const double quality = det(a, b, c) / lengths;
  // The derivative by each end, then the corner moves against all three.
  const Vec3 by_ends = (cross(b, c) + cross(c, a) + cross(a, b)) * (1 / lengths) -
                       quality * (a * (1 / norm_squared(a)) + b * (1 / norm_squared(b)) + c * (1 / norm_squared(c)));
  return -t.scale * by_ends;
}

double PointStar::worst(const Vec3& at) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < terms_.size(); ++i) least = std::min(least, value(i, at));
  return least;
}

void PointStar::measure(const Vec3& at, Measures& measures) const {
  measures.at = at;
  measures.values.resize(terms_.size());
  double worst = std::numeric_limits<double>::infinity(), worst_unweighted = worst;
  double sum = 0, shares = 0;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const double weighted = value(i, at), unweighted = weighted / weight(i);
    measures.values[i] = weighted;
    worst = std::min(worst, weighted);
    worst_unweighted = std::min(worst_unweighted, unweighted);
    sum += mean_share(i) * std::min(unweighted, terms_[i].rules.enough);
    shares += mean_share(i);
  }
  measures.worst = worst, measures.worst_unweighted = worst_unweighted;
  measures.mean = terms_.empty() ? 0 : sum / shares;
}

PointStar::Measures PointStar::measured(const Vec3& at) const {
  Measures measures;
  measure(at, measures);
  return measures;
}

bool PointStar::exceeds(const Vec3& at, double bound, std::vector<double>& values) const {
  values.resize(terms_.size());
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    values[i] = value(i, at);
    if (!(values[i] > bound)) return false;
  }
  return true;
}

bool PointStar::keeps_floors(const Measures& before, const Measures& after) const {
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const double there = after.values[i];
    if (is_below_floor(i, there) && there < before.values[i]) return false;
  }
  return true;
}

bool PointStar::keeps_floors(const Vec3& before, const Vec3& at) const {
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const double there = value(i, at);
    if (is_below_floor(i, there) && there < value(i, before)) return false;
  }
  return true;
}

Vec3 Freedom::allowed(const Vec3& direction) const {
  switch (kind) {
    case Kind::space:
      return direction;
    case Kind::plane:
      return direction - axis * dot(axis, direction);
    case Kind::line:
      return axis * dot(axis, direction);
    case Kind::none:
      break;
  }
  return {};
}

Vec3 shortest_in_hull(std::span<const Vec3> vectors) {
  // Gilbert: towards the vector that is furthest back, to the nearest point of the segment. A dozen rounds give one
  // digit or two, which a line search cannot tell from more.
  constexpr int rounds = 12;
  Vec3 at = vectors[0];
  for (int round = 0; round < rounds; ++round) {
    const Vec3* back = &vectors[0];
    for (const auto& v : vectors)
      if (dot(v, at) < dot(*back, at)) back = &v;
    const Vec3 to = *back - at;
    const double gain = -dot(at, to), length = norm_squared(to);
    if (length == 0 || gain <= 1e-3 * norm_squared(at)) break;
    at += to * std::min(1.0, gain / length);
  }
  return at;
}

namespace {

// The values and allowed gradients of all corners at a point.
struct Linearization {
  std::vector<double> values;
  std::vector<Vec3> gradients;
  double worst = 0;

  // `values` are those at the point.
  void find_worst() {
    worst = std::numeric_limits<double>::infinity();
    for (const double value : values) worst = std::min(worst, value);
  }
  void find_gradients(const PointStar& star, const Vec3& at, const Freedom& freedom) {
    gradients.resize(star.size());
    for (std::size_t i = 0; i < star.size(); ++i) gradients[i] = freedom.allowed(star.gradient(i, at));
  }

  // Where along `direction` another corner would become the worst, if all were linear.
  double reach(const Vec3& direction) const {
    const double rise = norm_squared(direction);
    // A corner cannot rise above 1: nothing further away can pay.
    double reach = (1.5 - worst) / rise;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double slope = dot(gradients[i], direction);
      if (slope < rise) reach = std::min(reach, std::max(values[i] - worst, 1e-3) / (rise - slope));
    }
    return reach;
  }
};

// False where the gradients cancel: the sum is then mere rounding, and a long step along it would leave the plane that
// holds the vertex.
bool is_direction(const Vec3& sum, std::span<const Vec3> gradients) {
  double longest = 0;
  for (const auto& g : gradients) longest = std::max(longest, norm_squared(g));
  return norm_squared(sum) > 1e-6 * longest;
}

}  // namespace

Placement raise_worst(const PointStar& star, const Vec3& start, int steps, const Freedom& freedom) {
  Linearization here;
  std::vector<Vec3> active;
  here.values.resize(star.size());
  for (std::size_t i = 0; i < star.size(); ++i) here.values[i] = star.value(i, start);
  here.find_worst();
  Placement best{start, here.worst};
  if (freedom.kind == Freedom::Kind::none) return best;
  here.find_gradients(star, start, freedom);
  std::vector<double> values;  // at a place that is tried
  double band = widest_band;
  for (int step = 0; step < steps; ++step) {
    active.clear();
    for (std::size_t i = 0; i < here.values.size(); ++i)
      if (here.values[i] <= here.worst + band) active.push_back(here.gradients[i]);
    const Vec3 direction = freedom.allowed(shortest_in_hull(active));
    double gain = 0;
    if (is_direction(direction, active)) {
      double length = here.reach(direction);
      for (int i = 0; i <= halvings; ++i, length /= 2) {
        const Vec3 at = best.at + direction * length;
        if (!star.exceeds(at, best.worst + least_gain, values)) continue;
        here.values.swap(values);
        here.find_worst();
        gain = here.worst - best.worst;
        best = {at, here.worst};
        break;
      }
    }
    if (gain == 0) {
      if (band <= narrowest_band) break;
      band /= 10;
      continue;
    }
    here.find_gradients(star, best.at, freedom);
  }
  return best;
}

Plane Plane::through(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = unit(cross(b - a, c - a));
  return {normal, dot(normal, a)};
}

Vec3 deepest_point(std::span<const Plane> planes, const Vec3& start) {
  constexpr int most_steps = 30;
  Vec3 at = start;
  std::vector<Vec3> active;
  for (int step = 0; step < most_steps; ++step) {
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    for (const auto& plane : planes) {
      least = std::min(least, plane.distance(at));
      greatest = std::max(greatest, plane.distance(at));
    }
    const double band = 1e-2 * (greatest - least);
    active.clear();
    for (const auto& plane : planes)
      if (plane.distance(at) <= least + band) active.push_back(plane.normal);
    const Vec3 direction = shortest_in_hull(active);
    const double rise = norm_squared(direction);
    // Nearly opposite normals: this is the deepest point, or the kernel has no inside.
    if (rise < 1e-6) break;
    double reach = std::numeric_limits<double>::infinity();
    for (const auto& plane : planes) {
      const double slope = dot(plane.normal, direction);
      if (slope < 0.5 * rise) reach = std::min(reach, std::max(plane.distance(at) - least, band) / (rise - slope));
    }
    if (reach == std::numeric_limits<double>::infinity()) break;
    at += direction * reach;
  }
  return at;
}

Placement raise_score(const PointStar& star, const PointStar::Measures& start, int steps, double floor,
                      const Freedom& freedom) {
  PointStar::Measures best = start, there;
  const double weighted_floor = std::min(floor, best.worst), unweighted_floor = std::min(floor, best.worst_unweighted);
  double score = star.score_of(best);
  double shares = 0;
  for (std::size_t i = 0; i < star.size(); ++i) shares += star.mean_share(i);
  std::vector<Vec3> gradients;
  for (int step = 0; step < steps; ++step) {
    gradients = {star.pull()};
    Vec3 sum = star.pull();
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (star.is_enough(i, best.values[i])) continue;
      gradients.push_back(star.gradient(i, best.at) * (star.mean_share(i) / star.weight(i) / shares));
      sum += gradients.back();
    }
    const Vec3 direction = freedom.allowed(freedom.allowed(sum));
    const double slope = norm_squared(direction);
    if (!is_direction(direction, gradients)) break;
    // The full step goes to where the linear model of the score reaches 1, or, with a pull, a little more than the
    // score.
    double length = std::max(1 - score, first_rise) / slope;
    bool moved = false;
    for (int i = 0; i <= 2 * halvings && !moved; ++i, length /= 2) {
      star.measure(best.at + direction * length, there);
      const double score_there = star.score_of(there);
      if (!(score_there > score + least_gain)) continue;
      if (there.worst < weighted_floor || there.worst_unweighted < unweighted_floor) continue;
      std::swap(best, there);
      score = score_there;
      moved = true;
    }
    if (!moved) break;
  }
  return {best.at, best.worst};
}

}  // namespace hexpipe::assemble::shape
