#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <tuple>

#include "tools/wrap/neighbourhood.hpp"
#include "tools/wrap/restoring_steps.hpp"
#include "tools/wrap/sharp_points.hpp"

namespace hexpipe::wrap {
namespace {

// Height over longest edge; remove_slivers() takes what is below.
constexpr double least_slimness_made = 0.04;
// A triangle across a sharp edge of 60 degrees stands askew by 60 degrees to both of its sides.
constexpr double least_side_cosine = -0.3;
// A point that a step adds. It gets its number when the step is taken.
constexpr Vertex added_point = std::numeric_limits<Vertex>::max();

class EdgeMender {
 public:
  EdgeMender(Surface& surface, const TriangleTree& input, const CutLimits& limits)
      : surface_(surface), input_(input), limits_(limits), finder_(input, limits.feature_angle) {}

  void run() {
    constexpr int most_rounds = 12;
    is_due_.assign(surface_.points.size(), true);
    for (int round = 0; round < most_rounds; ++round) {
      const bool any = take_without_crossings(
          surface_, [&]() -> const std::vector<Step>& { return take_steps_apart(); },
          [](const Step& step, const std::vector<char>& crosses) {
            return std::any_of(step.touched.begin(), step.touched.end(), [&](Vertex v) { return crosses[v] != 0; });
          },
          [&](const Step& step) { forbidden_.insert(step.name); });
      if (!any) return;
      is_due_ = is_due_next_;
    }
  }

 private:
  enum class Kind { flips, splits_edge, splits_triangle, moves, merges };
  using Name = std::tuple<Kind, Vertex, Vertex>;

  // Triangles go, others come; a point moves or is added.
  struct Step {
    Name name;
    std::vector<std::int32_t> gone;
    std::vector<Triangle> made;
    std::vector<Vec3> sides;  // of each made triangle: the normal of those that it stands for
    Vertex placed = no_index;
    Vec3 place{};
    std::vector<Vertex> touched;  // filled when the step is taken
  };

  const std::vector<Step>& take_steps_apart() {
    around_ = triangles_around(surface_);
    touched_.assign(surface_.points.size(), false);
    waits_.assign(surface_.points.size(), false);
    steps_.clear();
    const std::size_t count = surface_.triangles.size();
    for (std::size_t t = 0; t < count; ++t) {
      const Triangle triangle = surface_.triangles[t];
      if (is_any(triangle, touched_) || !is_any(triangle, is_due_) || !is_cut(triangle) || !is_near(triangle)) continue;
      waits_for_neighbour_ = false;
      auto step = best_step(static_cast<std::int32_t>(t));
      if (step) {
        steps_.push_back(std::move(*step));
        take(steps_.back());
      } else if (waits_for_neighbour_) {
        for (const Vertex v : triangle) waits_[v] = true;
      }
    }
    is_due_next_ = touched_;
    for (std::size_t v = 0; v < waits_.size(); ++v)
      if (waits_[v]) is_due_next_[v] = true;
    leave_out_merged_triangles(surface_);
    return steps_;
  }

  // What is made takes the places of triangles that go; those that are left over get equal corners.
  void take(Step& step) {
    if (step.placed == added_point) {
      step.placed = static_cast<Vertex>(surface_.points.size());
      surface_.points.push_back(step.place);
      touched_.push_back(true);
      waits_.push_back(false);
      is_due_.push_back(true);
      for (Triangle& t : step.made) std::replace(t.begin(), t.end(), added_point, step.placed);
    } else if (step.placed != no_index) {
      surface_.points[step.placed] = step.place;
    }
    std::set<Vertex> all;
    for (const std::int32_t t : step.gone) all.insert(surface_.triangles[t].begin(), surface_.triangles[t].end());
    for (const Triangle& t : step.made) all.insert(t.begin(), t.end());
    step.touched.assign(all.begin(), all.end());
    for (const Vertex v : all) touched_[v] = true;
    for (std::size_t i = 0; i < std::max(step.gone.size(), step.made.size()); ++i) {
      if (i >= step.gone.size())
        surface_.triangles.push_back(step.made[i]);
      else if (Triangle& t = surface_.triangles[step.gone[i]]; i < step.made.size())
        t = step.made[i];
      else
        t = {t[0], t[0], t[0]};
    }
  }

  Vec3 middle_of(const Triangle& t) const {
    return (1.0 / 3) * (surface_.points[t[0]] + surface_.points[t[1]] + surface_.points[t[2]]);
  }
  Vec3 middle_of(Vertex u, Vertex v) const { return 0.5 * (surface_.points[u] + surface_.points[v]); }
  Vec3 normal_of(const Triangle& t) const {
    const auto& p = surface_.points;
    return unit(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
  }
  double size_of(const Triangle& t) const {
    const auto& p = surface_.points;
    return std::max({norm(p[t[1]] - p[t[0]]), norm(p[t[2]] - p[t[1]]), norm(p[t[0]] - p[t[2]])});
  }

  static bool is_any(const Triangle& t, const std::vector<char>& marks) {
    return marks[t[0]] || marks[t[1]] || marks[t[2]];
  }

  // Triangles that span a gap have nothing to go to.
  bool is_near(const Triangle& t) const {
    return std::all_of(t.begin(), t.end(),
                       [&](Vertex v) { return input_.distance(surface_.points[v]) <= limits_.reach; });
  }

  bool is_cut(const Triangle& t) const {
    if (input_.distance(middle_of(t)) > limits_.off) return true;
    for (std::size_t i = 0; i < 3; ++i)
      if (input_.distance(middle_of(t[i], t[(i + 1) % 3])) > limits_.off) return true;
    return false;
  }

  std::int32_t beyond(std::int32_t t, Vertex u, Vertex v) const {
    for (const std::int32_t other : around_[u])
      if (other != t && has(surface_.triangles[other], u) && has(surface_.triangles[other], v)) return other;
    return no_index;
  }

  static Vertex opposite(const Triangle& t, Vertex u, Vertex v) {
    for (const Vertex w : t)
      if (w != u && w != v) return w;
    return no_index;
  }

  // The planes of the input under a triangle and its neighbours, those next to its middle first.
  std::vector<Plane> planes_under(std::int32_t t, const std::array<std::int32_t, 3>& beside) const {
    constexpr std::size_t most = 4;
    constexpr double share = 0.8;  // of the way from the middle to a corner
    std::vector<Plane> planes;
    const auto add = [&](const Vec3& at, const Vec3& side) {
      const Plane plane = input_.nearest_plane(at, side);
      const auto differs = [&](const Plane& other) { return finder_.is_sharp(plane, other); };
      if (planes.size() < most && std::all_of(planes.begin(), planes.end(), differs)) planes.push_back(plane);
    };
    const auto add_triangle = [&](const Triangle& triangle) {
      const Vec3 middle = middle_of(triangle), side = normal_of(triangle);
      add(middle, side);
      for (const Vertex v : triangle) add(middle + share * (surface_.points[v] - middle), side);
    };
    add_triangle(surface_.triangles[t]);
    for (const std::int32_t other : beside)
      if (other != no_index) add_triangle(surface_.triangles[other]);
    return planes;
  }

  // The step that brings the surface nearest to the input, with a word for the shape of the triangles.
  std::optional<Step> best_step(std::int32_t t) const {
    const Triangle triangle = surface_.triangles[t];
    std::array<std::int32_t, 3> beside{};
    for (std::size_t i = 0; i < 3; ++i) beside[i] = beyond(t, triangle[i], triangle[(i + 1) % 3]);
    const std::vector<Plane> planes = planes_under(t, beside);
    if (planes.size() < 2) return std::nullopt;
    const auto places = finder_.find_all(middle_of(triangle), size_of(triangle), planes);
    std::optional<Step> best;
    double most = 0;
    const auto consider = [&](Step&& step) {
      const double found = worth(step);
      if (found > most) most = found, best = std::move(step);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex u = triangle[i], v = triangle[(i + 1) % 3], w = triangle[(i + 2) % 3];
      if (beside[i] == no_index) continue;
      consider_edge(t, beside[i], u, v, w, places, consider);
      consider_merging(u, v, places, consider);
      consider_merging(v, u, places, consider);
      for (const Vec3& place : places) consider(moving(u, place));
    }
    for (const Vec3& place : places) {
      const Vec3 side = normal_of(triangle);
      const auto [a, b, c] = triangle;
      consider(Step{{Kind::splits_triangle, std::min({a, b, c}), std::max({a, b, c})},
                    {t},
                    {{a, b, added_point}, {b, c, added_point}, {c, a, added_point}},
                    {side, side, side},
                    added_point,
                    place,
                    {}});
    }
    return best;
  }

  template <class Consider>
  void consider_edge(std::int32_t t, std::int32_t other, Vertex u, Vertex v, Vertex w, const std::vector<Vec3>& places,
                     Consider&& consider) const {
    const Vertex x = opposite(surface_.triangles[other], u, v);
    const Vec3 one = normal_of(surface_.triangles[t]), two = normal_of(surface_.triangles[other]);
    if (beyond(no_index, w, x) == no_index) {
      const Vec3 side = unit(one + two);
      consider(Step{{Kind::flips, std::min(u, v), std::max(u, v)},
                    {t, other},
                    {{u, x, w}, {x, v, w}},
                    {side, side},
                    no_index,
                    {},
                    {}});
    }
    for (const Vec3& place : places)
      consider(Step{{Kind::splits_edge, std::min(u, v), std::max(u, v)},
                    {t, other},
                    {{u, added_point, w}, {added_point, v, w}, {v, added_point, x}, {added_point, u, x}},
                    {one, one, two, two},
                    added_point,
                    place,
                    {}});
  }

  Step moving(Vertex v, const Vec3& place) const {
    Step step{{Kind::moves, v, v}, around_[v], {}, {}, v, place, {}};
    for (const std::int32_t t : around_[v]) {
      step.made.push_back(surface_.triangles[t]);
      step.sides.push_back(normal_of(surface_.triangles[t]));
    }
    return step;
  }

  template <class Consider>
  void consider_merging(Vertex from, Vertex to, const std::vector<Vec3>& places, Consider&& consider) const {
    if (!may_merge(surface_, around_, from, to)) return;
    const auto add = [&](Step& step, std::int32_t t) {
      Triangle triangle = surface_.triangles[t];
      step.gone.push_back(t);
      if (has(triangle, from) && has(triangle, to)) return;
      std::replace(triangle.begin(), triangle.end(), from, to);
      step.made.push_back(triangle);
      step.sides.push_back(normal_of(surface_.triangles[t]));
    };
    Step step{{Kind::merges, from, to}, {}, {}, {}, no_index, {}, {}};
    for (const std::int32_t t : around_[from]) add(step, t);
    consider(Step(step));
    if (from > to) return;
    for (const std::int32_t t : around_[to])
      if (!has(surface_.triangles[t], from)) add(step, t);
    step.placed = to;
    for (const Vec3& place : places) {
      step.place = place;
      consider(Step(step));
    }
  }

  // 0 or less: not to be taken.
  double worth(const Step& step) const {
    constexpr double least_gain = 0.2, good_slimness = 0.2, price_of_point = 0.7;
    if (forbidden_.contains(step.name)) return 0;
    for (const std::int32_t t : step.gone)
      for (const Vertex v : surface_.triangles[t])
        if (touched_[v]) {
          waits_for_neighbour_ = true;
          return 0;
        }
    double slimness = 1;
    const auto at = [&](Vertex v) { return v == step.placed ? step.place : surface_.points[v]; };
    for (std::size_t i = 0; i < step.made.size(); ++i) {
      const std::array<Vec3, 3> corners{at(step.made[i][0]), at(step.made[i][1]), at(step.made[i][2])};
      const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
      const std::array<double, 3> edges{norm(corners[1] - corners[0]), norm(corners[2] - corners[1]),
                                        norm(corners[0] - corners[2])};
      const auto [shortest, longest] = std::minmax_element(edges.begin(), edges.end());
      if (*shortest < limits_.shortest_edge) return 0;
      slimness = std::min(slimness, norm(normal) / (*longest * *longest));
      if (slimness < least_slimness_made || dot(unit(normal), step.sides[i]) < least_side_cosine) return 0;
    }
    double before = 0, after = 0;
    for (const std::int32_t t : step.gone) {
      const Triangle& triangle = surface_.triangles[t];
      before += misfit({surface_.points[triangle[0]], surface_.points[triangle[1]], surface_.points[triangle[2]]});
    }
    for (const Triangle& t : step.made) {
      after += misfit({at(t[0]), at(t[1]), at(t[2])});
      if (after > (1 - least_gain) * before) return 0;
    }
    return (before - after) * std::min(1.0, slimness / good_slimness) *
           (step.placed == added_point ? price_of_point : 1);
  }

  // About the area between a triangle's edges and the input, and the triangle and the input.
  double misfit(const std::array<Vec3, 3>& at) const {
    double sum = 0, longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &a = at[i], &b = at[(i + 1) % 3];
      const double length = norm(b - a);
      longest = std::max(longest, length);
      // An edge is half of each of its triangles.
      sum += 0.5 * length * input_.distance(0.5 * (a + b));
    }
    return sum + longest * input_.distance((1.0 / 3) * (at[0] + at[1] + at[2]));
  }

  Surface& surface_;
  const TriangleTree& input_;
  CutLimits limits_;
  SharpPointFinder finder_;
  TrianglesAround around_;
  // Of each point: a step changed a triangle at it in this round; a triangle at it is looked at in this round, in the
  // next one; a step of a triangle at it has to wait for the next round.
  std::vector<char> touched_, is_due_, is_due_next_, waits_;
  mutable bool waits_for_neighbour_ = false;
  std::vector<Step> steps_;
  std::set<Name> forbidden_;
};

}  // namespace

void mend_cut_edges(Surface& surface, const TriangleTree& input, const CutLimits& limits) {
  EdgeMender(surface, input, limits).run();
}

}  // namespace hexpipe::wrap
