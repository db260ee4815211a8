#include "tools/wrap/restoring_steps.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <optional>

#include "tools/wrap/neighbourhood.hpp"
#include "tools/wrap/shrink_wrap.hpp"

namespace hexpipe::wrap {
namespace {

class StraySettler {
 public:
  StraySettler(Surface& surface, std::vector<char>& is_stray, const std::vector<Vec3>& targets,
               const TriangleTree& input, bool lets_sum_decide)
      : surface_(surface),
        is_stray_(is_stray),
        targets_(targets),
        input_(input),
        lets_sum_decide_(lets_sum_decide),
        stays_(surface.points.size()) {}

  // As many as do not touch each other; false: none.
  bool round() {
    const bool any = take_without_crossings(
        surface_, [&]() -> const std::vector<Step>& { return settle_apart(); },
        [](const Step& step, const std::vector<char>& crosses) { return crosses[step.at()] != 0; },
        [&](const Step& step) { stays_[step.stray] = true; });
    if (any)
      for (const Step& step : steps_) is_stray_[step.stray] = false;
    return any;
  }

 private:
  struct Step {
    Vertex stray;
    Vertex into;  // a neighbour; no_index: it goes to its target
    Vertex at() const { return into == no_index ? stray : into; }
  };

  const std::vector<Step>& settle_apart() {
    const TrianglesAround around = triangles_around(surface_);
    std::vector<char> touched(surface_.points.size());
    steps_.clear();
    for (Vertex v = 0; v < static_cast<Vertex>(surface_.points.size()); ++v) {
      if (!is_stray_[v] || stays_[v] || touched[v] || around[v].empty()) continue;
      const auto ring = neighbours(surface_, around[v], v);
      if (std::any_of(ring.begin(), ring.end(), [&](Vertex w) { return touched[w]; })) continue;
      const auto step = best_step(v, ring, around);
      if (!step) continue;
      take(*step, around[v]);
      touched[v] = true;
      for (const Vertex w : ring) touched[w] = true;
      steps_.push_back(*step);
    }
    leave_out_merged_triangles(surface_);
    return steps_;
  }

  void take(const Step& step, const std::vector<std::int32_t>& around) {
    if (step.into == no_index)
      surface_.points[step.stray] = targets_[step.stray];
    else
      for (const std::int32_t t : around)
        std::replace(surface_.triangles[t].begin(), surface_.triangles[t].end(), step.stray, step.into);
  }

  std::optional<Step> best_step(Vertex v, const std::vector<Vertex>& ring, const TrianglesAround& around) const {
    const Misfit now = misfit(v, no_index, surface_.points[v], around[v]);
    Misfit least = now;
    std::optional<Step> best;
    const auto consider = [&](const Step& step, const Vec3& place) {
      if (!keeps_sides(v, step.into, place, around[v])) return;
      const Misfit found = misfit(v, step.into, place, around[v]);
      if (found.greatest >= now.greatest && (step.into != no_index || !lets_sum_decide_)) return;
      if (found < least) least = found, best = step;
    };
    consider({v, no_index}, targets_[v]);
    for (const Vertex w : ring)
      if (!is_stray_[w] && may_merge(surface_, around, v, w)) consider({v, w}, surface_.points[w]);
    return best;
  }

  // Calls visit(before, after) with the corners of each triangle around a point that goes to `place`, but for those
  // that have `into` and so vanish.
  template <class Visit>
  void for_each_changed(Vertex v, Vertex into, const Vec3& place, const std::vector<std::int32_t>& around,
                        Visit&& visit) const {
    for (const std::int32_t t : around) {
      const Triangle& triangle = surface_.triangles[t];
      if (into != no_index && has(triangle, into)) continue;
      std::array<Vec3, 3> before{}, after{};
      for (std::size_t i = 0; i < 3; ++i) {
        before[i] = surface_.points[triangle[i]];
        after[i] = triangle[i] == v ? place : before[i];
      }
      visit(before, after);
    }
  }

  bool keeps_sides(Vertex v, Vertex into, const Vec3& place, const std::vector<std::int32_t>& around) const {
    // A triangle at a stray point stands askew already: it may turn further than others.
    constexpr double least_cosine = 0, least_share = 1e-3;
    bool keeps = true;
    for_each_changed(v, into, place, around, [&](const auto& before, const auto& after) {
      const Vec3 old_normal = cross(before[1] - before[0], before[2] - before[0]);
      const Vec3 normal = cross(after[1] - after[0], after[2] - after[0]);
      const double longest = std::max(
          {norm_squared(after[1] - after[0]), norm_squared(after[2] - after[1]), norm_squared(after[0] - after[2])});
      keeps = keeps && norm(normal) >= least_share * longest && dot(old_normal, normal) > least_cosine;
    });
    return keeps;
  }

  // How far middles of triangles and edges are from the input.
  struct Misfit {
    double greatest = 0, sum = 0;
    auto operator<=>(const Misfit&) const = default;
  };

  Misfit misfit(Vertex v, Vertex into, const Vec3& place, const std::vector<std::int32_t>& around) const {
    Misfit result;
    const auto count = [&](const Vec3& middle) {
      const double distance = input_.distance(middle);
      result.greatest = std::max(result.greatest, distance);
      result.sum += distance;
    };
    for_each_changed(v, into, place, around, [&](const auto&, const auto& at) {
      count((1.0 / 3) * (at[0] + at[1] + at[2]));
      for (std::size_t i = 0; i < 3; ++i) count(0.5 * (at[i] + at[(i + 1) % 3]));
    });
    return result;
  }

  Surface& surface_;
  std::vector<char>& is_stray_;
  const std::vector<Vec3>& targets_;
  const TriangleTree& input_;
  bool lets_sum_decide_;
  std::vector<char> stays_;
  std::vector<Step> steps_;
};

}  // namespace

void settle_strays(Surface& surface, std::vector<char>& is_stray, const std::vector<Vec3>& targets,
                   const TriangleTree& input) {
  // First the steps that bring the greatest distance down. Where several strays are neighbours that may be another
  // one's, so then a point goes to its target if the sum becomes less.
  for (const bool lets_sum_decide : {false, true}) {
    StraySettler settler(surface, is_stray, targets, input, lets_sum_decide);
    while (settler.round()) {
    }
  }
}

}  // namespace hexpipe::wrap
