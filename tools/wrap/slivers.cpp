#include "tools/wrap/restoring_steps.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "tools/wrap/neighbourhood.hpp"
#include "tools/wrap/shrink_wrap.hpp"

namespace hexpipe::wrap {
namespace {

// Height over longest edge: an angle of about a degree. TetGen's own arithmetic fails from about 1e-8 on.
constexpr double least_slimness = 0.02;
// Two neighbours with less than this between their normals' directions are folded onto each other, to within 8 degrees.
constexpr double folded_cosine = -0.99;

struct Shape {
  Vec3 normal;  // a unit normal, or zero without an area
  double slimness, shortest;
};

Shape shape_of(const std::array<Vec3, 3>& at) {
  const Vec3 normal = cross(at[1] - at[0], at[2] - at[0]);
  const double area = norm(normal);
  const std::array<double, 3> edges{norm(at[1] - at[0]), norm(at[2] - at[1]), norm(at[0] - at[2])};
  const auto [shortest, longest] = std::minmax_element(edges.begin(), edges.end());
  const double slimness = *longest > 0 ? area / (*longest * *longest) : 0;
  return {area > 0 ? (1 / area) * normal : Vec3{}, slimness, *shortest};
}

class SliverRemover {
 public:
  SliverRemover(Surface& surface, const TriangleTree& input, const SliverLimits& limits)
      : surface_(surface), input_(input), limits_(limits) {}

  std::size_t run() {
    while (round()) {
    }
    const TrianglesAround around = triangles_around(surface_);
    std::size_t left = 0;
    for (const Triangle& t : surface_.triangles) left += is_bad(t, around);
    return left;
  }

 private:
  // Merges `from` into `to`, or makes the edge from..to out of that between the two points opposite it.
  struct Step {
    Vertex from, to;
    std::array<std::int32_t, 2> flipped{no_index, no_index};  // the two triangles of a flip
    std::array<Triangle, 2> made{};
    bool flips() const { return flipped[0] != no_index; }
  };

  bool round() {
    const bool any = take_without_crossings(
        surface_, [&]() -> const std::vector<Step>& { return take_steps_apart(); },
        [](const Step& step, const std::vector<char>& crosses) {
          return crosses[step.to] || (step.flips() && crosses[step.from]);
        },
        [&](const Step& step) { forbid(step); });
    // So that flips do not come back for ever.
    if (any)
      for (const Step& step : steps_) forbid(step);
    return any;
  }

  void forbid(const Step& step) { forbidden_.insert({step.from, step.to}); }

  const std::vector<Step>& take_steps_apart() {
    const TrianglesAround around = triangles_around(surface_);
    std::vector<char> touched(surface_.points.size());
    steps_.clear();
    const std::vector<Triangle> triangles = surface_.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (is_touched(triangles[t], touched) || !is_bad(triangles[t], around)) continue;
      const auto step = best_step(static_cast<std::int32_t>(t), around, touched);
      if (!step) continue;
      touch(*step, around, touched);
      take(*step, around);
      steps_.push_back(*step);
    }
    leave_out_merged_triangles(surface_);
    return steps_;
  }

  static bool is_touched(const Triangle& t, const std::vector<char>& touched) {
    return touched[t[0]] || touched[t[1]] || touched[t[2]];
  }

  void touch(const Step& step, const TrianglesAround& around, std::vector<char>& touched) const {
    for (const Vertex v : {step.from, step.to})
      for (const std::int32_t t : around[v])
        for (const Vertex w : surface_.triangles[t]) touched[w] = true;
  }

  void take(const Step& step, const TrianglesAround& around) {
    if (step.flips())
      for (std::size_t i = 0; i < 2; ++i) surface_.triangles[step.flipped[i]] = step.made[i];
    else
      for (const std::int32_t t : around[step.from])
        std::replace(surface_.triangles[t].begin(), surface_.triangles[t].end(), step.from, step.to);
  }

  std::array<Vec3, 3> corners(const Triangle& t) const {
    return {surface_.points[t[0]], surface_.points[t[1]], surface_.points[t[2]]};
  }

  // The other triangle at an edge; no_index where a step beside it changed that.
  std::int32_t beyond(std::int32_t t, Vertex u, Vertex v, const TrianglesAround& around) const {
    for (const std::int32_t other : around[u])
      if (other != t && has(surface_.triangles[other], u) && has(surface_.triangles[other], v)) return other;
    return no_index;
  }

  bool is_bad(const Triangle& t, const TrianglesAround& around) const {
    const Shape shape = shape_of(corners(t));
    if (shape.slimness < least_slimness || shape.shortest < limits_.shortest_edge) return true;
    for (std::size_t i = 0; i < 3; ++i)
      for (const std::int32_t other : around[t[i]]) {
        const Triangle& next = surface_.triangles[other];
        if (next != t && has(next, t[(i + 1) % 3]) && is_folded(shape, shape_of(corners(next)))) return true;
      }
    return false;
  }

  static bool is_folded(const Shape& shape, const Shape& next) {
    return next.slimness >= least_slimness && dot(shape.normal, next.normal) < folded_cosine;
  }

  // The step that removes most bad triangles, and of equal ones the one whose worst triangle is best. It must come near
  // enough to the input.
  std::optional<Step> best_step(std::int32_t t, const TrianglesAround& around, const std::vector<char>& touched) const {
    std::optional<Step> best;
    std::ptrdiff_t most_removed = 0;
    double greatest = 0;
    const auto consider = [&](const Step& step, std::ptrdiff_t bad, const std::vector<std::array<Vec3, 3>>& before,
                              const std::vector<std::array<Vec3, 3>>& after) {
      if (forbidden_.contains({step.from, step.to}) || !keeps_sides(before, after)) return;
      const auto [bad_after, slimness] = quality_of(after);
      const std::ptrdiff_t removed = bad - bad_after;
      if (removed <= 0 || std::pair(removed, slimness) <= std::pair(most_removed, greatest)) return;
      if (misfit(after) > std::max(limits_.misfit, misfit(before))) return;
      most_removed = removed;
      greatest = slimness;
      best = step;
    };
    const Triangle& triangle = surface_.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex u = triangle[i], v = triangle[(i + 1) % 3], w = triangle[(i + 2) % 3];
      for (const auto& [from, to] : {std::pair{u, v}, std::pair{v, u}})
        consider_merging(from, to, around, touched, consider);
      consider_flipping(t, u, v, w, around, touched, consider);
    }
    return best;
  }

  template <class Consider>
  void consider_merging(Vertex from, Vertex to, const TrianglesAround& around, const std::vector<char>& touched,
                        Consider&& consider) const {
    const auto is_free = [&](std::int32_t t) { return !is_touched(surface_.triangles[t], touched); };
    if (!std::all_of(around[from].begin(), around[from].end(), is_free) || !may_merge(surface_, around, from, to))
      return;
    std::vector<std::array<Vec3, 3>> before, after;
    std::ptrdiff_t bad = 0;
    for (const std::int32_t t : around[from]) {
      Triangle triangle = surface_.triangles[t];
      bad += is_bad(triangle, around);
      if (has(triangle, to)) continue;
      before.push_back(corners(triangle));
      std::replace(triangle.begin(), triangle.end(), from, to);
      after.push_back(corners(triangle));
    }
    consider(Step{from, to}, bad, before, after);
  }

  template <class Consider>
  void consider_flipping(std::int32_t t, Vertex u, Vertex v, Vertex w, const TrianglesAround& around,
                         const std::vector<char>& touched, Consider&& consider) const {
    const std::int32_t other = beyond(t, u, v, around);
    if (other == no_index || is_touched(surface_.triangles[other], touched)) return;
    Vertex x = no_index;
    for (const Vertex y : surface_.triangles[other])
      if (y != u && y != v) x = y;
    if (x == no_index || x == w || beyond(no_index, w, x, around) != no_index) return;
    const std::array<Triangle, 2> made{Triangle{u, x, w}, Triangle{x, v, w}};
    const Triangle &one = surface_.triangles[t], &two = surface_.triangles[other];
    consider(Step{w, x, {t, other}, made}, is_bad(one, around) + is_bad(two, around), {corners(one), corners(two)},
             {corners(made[0]), corners(made[1])});
  }

  // A triangle without an area has no side that it could keep. A flip keeps sides if both new triangles face as the old
  // ones with an area do.
  static bool keeps_sides(const std::vector<std::array<Vec3, 3>>& before,
                          const std::vector<std::array<Vec3, 3>>& after) {
    constexpr double least_cosine = 0.3;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Shape old_shape = shape_of(before[i]), shape = shape_of(after[i]);
      if (old_shape.slimness >= least_slimness && dot(old_shape.normal, shape.normal) < least_cosine) return false;
    }
    return true;
  }

  struct Quality {
    std::ptrdiff_t bad;
    double slimness;  // the least
  };

  Quality quality_of(const std::vector<std::array<Vec3, 3>>& triangles) const {
    Quality quality{0, 1};
    for (const auto& at : triangles) {
      const Shape shape = shape_of(at);
      quality.bad += shape.slimness < least_slimness || shape.shortest < limits_.shortest_edge;
      quality.slimness = std::min(quality.slimness, shape.slimness);
    }
    return quality;
  }

  // How far middles of triangles and edges are from the input at most.
  double misfit(const std::vector<std::array<Vec3, 3>>& triangles) const {
    double greatest = 0;
    for (const auto& at : triangles) {
      greatest = std::max(greatest, input_.distance((1.0 / 3) * (at[0] + at[1] + at[2])));
      for (std::size_t i = 0; i < 3; ++i)
        greatest = std::max(greatest, input_.distance(0.5 * (at[i] + at[(i + 1) % 3])));
    }
    return greatest;
  }

  Surface& surface_;
  const TriangleTree& input_;
  SliverLimits limits_;
  std::vector<Step> steps_;
  std::set<std::pair<Vertex, Vertex>> forbidden_;
};

}  // namespace

std::size_t remove_slivers(Surface& surface, const TriangleTree& input, const SliverLimits& limits) {
  return SliverRemover(surface, input, limits).run();
}

}  // namespace hexpipe::wrap
