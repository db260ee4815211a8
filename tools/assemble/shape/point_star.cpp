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

// One number in a lane of each component.
void set_lane(LaneVector& vectors, int lane, const Vec3& v) {
  vectors.x[lane] = v.x, vectors.y[lane] = v.y, vectors.z[lane] = v.z;
}

LaneVector times(const LaneVector& a, const Lanes& s) {
  return {a.x * s, a.y * s, a.z * s};
}

}  // namespace

struct PointStar::Formulas {
  static void find_values(std::span<const EndBlock> at_ends, std::span<const CornerBlock> at_corners, const Vec3& at,
                          double* values);
  static void find_gradients(std::span<const EndBlock> at_ends, std::span<const CornerBlock> at_corners, const Vec3& at,
                             Vec3* gradients);

  static LaneVector from(const Vec3& at) { return {Lanes{} + at.x, Lanes{} + at.y, Lanes{} + at.z}; }
  static Lanes product_of_norms(const LaneVector& a, const LaneVector& b, const LaneVector& c) {
    return square_root(norm_squared(a) * norm_squared(b) * norm_squared(c));
  }
  static Lanes values_of(const EndBlock& block, const LaneVector& at) {
    const LaneVector a = at - block.corner;
    const Lanes length = square_root(norm_squared(a));
    return select(length > 0, block.scale * dot(a, block.normal) / length, Lanes{});
  }
  static Lanes values_of(const CornerBlock& block, const LaneVector& at) {
    const auto& [first, second, third] = block.neighbours;
    const LaneVector a = first - at, b = second - at, c = third - at;
    const Lanes lengths = product_of_norms(a, b, c);
    return select(lengths > 0, block.scale * det(a, b, c) / lengths, Lanes{});
  }
  static LaneVector gradients_of(const EndBlock& block, const LaneVector& at) {
    const LaneVector a = at - block.corner;
    const Lanes length = square_root(norm_squared(a));
    const LaneVector across = block.normal - times(a, dot(a, block.normal) / (length * length));
    const LaneVector there = times(across, block.scale / length), here = times(block.normal, block.scale);
    return {select(length > 0, there.x, here.x), select(length > 0, there.y, here.y),
            select(length > 0, there.z, here.z)};
  }
  static LaneVector gradients_of(const CornerBlock& block, const LaneVector& at) {
    const auto& [first, second, third] = block.neighbours;
    const LaneVector a = first - at, b = second - at, c = third - at;
    const Lanes lengths = product_of_norms(a, b, c), quality = det(a, b, c) / lengths;
    // The derivative by each end, then the corner moves against all three.
    const LaneVector pulls =
        times(a, 1 / norm_squared(a)) + times(b, 1 / norm_squared(b)) + times(c, 1 / norm_squared(c));
    const LaneVector by_ends = times(cross(b, c) + cross(c, a) + cross(a, b), 1 / lengths) - times(pulls, quality);
    const LaneVector result = times(by_ends, -block.scale);
    return {select(lengths > 0, result.x, Lanes{}), select(lengths > 0, result.y, Lanes{}),
            select(lengths > 0, result.z, Lanes{})};
  }
  template <class OneBlock>
  static void put_values(const OneBlock& block, const LaneVector& at, double* values) {
    const Lanes found = values_of(block, at);
    for (int lane = 0; lane < block.count; ++lane) values[block.terms[lane]] = found[lane];
  }
  template <class OneBlock>
  static void put_gradients(const OneBlock& block, const LaneVector& at, Vec3* gradients) {
    const LaneVector found = gradients_of(block, at);
    for (int lane = 0; lane < block.count; ++lane)
      gradients[block.terms[lane]] = {found.x[lane], found.y[lane], found.z[lane]};
  }
};

HEXPIPE_ANY_REGISTERS void PointStar::Formulas::find_values(std::span<const EndBlock> at_ends,
                                                            std::span<const CornerBlock> at_corners, const Vec3& at,
                                                            double* values) {
  const LaneVector place = from(at);
  for (const EndBlock& block : at_ends) put_values(block, place, values);
  for (const CornerBlock& block : at_corners) put_values(block, place, values);
}

HEXPIPE_ANY_REGISTERS void PointStar::Formulas::find_gradients(std::span<const EndBlock> at_ends,
                                                               std::span<const CornerBlock> at_corners, const Vec3& at,
                                                               Vec3* gradients) {
  const LaneVector place = from(at);
  for (const EndBlock& block : at_ends) put_gradients(block, place, gradients);
  for (const CornerBlock& block : at_corners) put_gradients(block, place, gradients);
}

void PointStar::add(CellKind kind, std::span<const Vec3> corners, int moving, const CornerRules& rules) {
  const Term term{rules.weight, rules.share, rules.enough, rules.floor};
  const double scale = kind == CellKind::tet ? rules.weight * tet_scale : rules.weight;
  with_topology(kind, [&](auto topology) {
    for (const auto& corner : decltype(topology)::corners) add_corner(corners, corner, moving, term, scale);
  });
}

// The lane of a new corner, which has this number.
template <class OneBlock>
int PointStar::next_lane(std::vector<OneBlock>& blocks, std::size_t term) {
  if (blocks.empty() || blocks.back().count == lane_count) blocks.emplace_back();
  Block& block = blocks.back();
  block.terms[block.count] = static_cast<std::int32_t>(term);
  return block.count++;
}

void PointStar::add_corner(std::span<const Vec3> corners, const LocalCorner& corner, int moving, const Term& term,
                           double scale) {
  if (corner[0] == moving) {
    const int lane = next_lane(at_corners_, terms_.size());
    CornerBlock& block = at_corners_.back();
    for (std::size_t i = 0; i < 3; ++i) set_lane(block.neighbours[i], lane, corners[corner[i + 1]]);
    block.scale[lane] = scale;
    terms_.push_back(term);
    return;
  }
  for (int i = 1; i < 4; ++i) {
    if (corner[i] != moving) continue;
    const Vec3 o = corners[corner[0]];
    const Vec3 b = corners[corner[i % 3 + 1]] - o, c = corners[corner[(i + 1) % 3 + 1]] - o;
    const double lengths = std::sqrt(norm_squared(b) * norm_squared(c));
    const int lane = next_lane(at_ends_, terms_.size());
    EndBlock& block = at_ends_.back();
    set_lane(block.corner, lane, o);
    set_lane(block.normal, lane, cross(b, c) * (lengths > 0 ? 1 / lengths : 0));
    block.scale[lane] = scale;
    terms_.push_back(term);
  }
}

void PointStar::find_values(const Vec3& at, std::vector<double>& values) const {
  values.resize(terms_.size());
  Formulas::find_values(at_ends_, at_corners_, at, values.data());
}

void PointStar::find_gradients(const Vec3& at, std::vector<Vec3>& gradients) const {
  gradients.resize(terms_.size());
  Formulas::find_gradients(at_ends_, at_corners_, at, gradients.data());
}

double PointStar::worst(const Vec3& at) const {
  std::vector<double> values;
  find_values(at, values);
  double least = std::numeric_limits<double>::infinity();
  for (const double value : values) least = std::min(least, value);
  return least;
}

void PointStar::measure(const Vec3& at, Measures& measures) const {
  measures.at = at;
  find_values(at, measures.values);
  double worst = std::numeric_limits<double>::infinity(), worst_unweighted = worst;
  double sum = 0, shares = 0;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const double weighted = measures.values[i], unweighted = weighted / weight(i);
    worst = std::min(worst, weighted);
    worst_unweighted = std::min(worst_unweighted, unweighted);
    sum += mean_share(i) * std::min(unweighted, terms_[i].enough);
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
  find_values(at, values);
  return std::ranges::all_of(values, [&](double value) { return value > bound; });
}

bool PointStar::keeps_floors(const Measures& before, const Measures& after) const {
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const double there = after.values[i];
    if (is_below_floor(i, there) && there < before.values[i]) return false;
  }
  return true;
}

bool PointStar::keeps_floors(const Vec3& before, const Vec3& at) const {
  std::vector<double> values_before, values;
  find_values(at, values);
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (!is_below_floor(i, values[i])) continue;
    if (values_before.empty()) find_values(before, values_before);
    if (values[i] < values_before[i]) return false;
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
    star.find_gradients(at, gradients);
    for (Vec3& gradient : gradients) gradient = freedom.allowed(gradient);
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
  star.find_values(start, here.values);
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
  std::vector<Vec3> of_corners, gradients;
  for (int step = 0; step < steps; ++step) {
    gradients = {star.pull()};
    Vec3 sum = star.pull();
    star.find_gradients(best.at, of_corners);
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (star.is_enough(i, best.values[i])) continue;
      gradients.push_back(of_corners[i] * (star.mean_share(i) / star.weight(i) / shares));
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
