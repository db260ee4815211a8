#include "tools/wrap/stray_points.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include "tools/wrap/shrink_wrap.hpp"

namespace hexpipe::wrap {
namespace {

bool has(const Triangle& t, Vertex v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

using TrianglesAround = std::vector<std::vector<std::int32_t>>;

TrianglesAround triangles_around(const Surface& surface) {
  TrianglesAround around(surface.points.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const Vertex v : surface.triangles[t]) around[v].push_back(static_cast<std::int32_t>(t));
  return around;
}

std::vector<Vertex> neighbours(const Surface& surface, const std::vector<std::int32_t>& around, Vertex v) {
  std::vector<Vertex> result;
  for (const std::int32_t t : around)
    for (const Vertex w : surface.triangles[t])
      if (w != v) result.push_back(w);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

class StraySettler {
 public:
  StraySettler(Surface& surface, std::vector<char>& is_stray, const std::vector<Vec3>& targets,
               const TriangleTree& input)
      : surface_(surface), is_stray_(is_stray), targets_(targets), input_(input), stays_(surface.points.size()) {}

  // As many as do not touch each other; false: none. What makes the surface cross itself is taken back and not tried
  // again.
  bool round() {
    for (;;) {
      const Surface before = surface_;
      settle_apart();
      if (steps_.empty()) return false;
      const auto crossing = crossing_triangles(surface_);
      if (crossing.empty()) {
        for (const Step& step : steps_) is_stray_[step.stray] = false;
        return true;
      }
      std::vector<char> crosses(surface_.points.size());
      for (const std::int32_t t : crossing)
        for (const Vertex v : surface_.triangles[t]) crosses[v] = true;
      bool blamed = false;
      for (const Step& step : steps_)
        if (crosses[step.at()]) stays_[step.stray] = blamed = true;
      // Then a triangle beside them crosses: all are suspect.
      if (!blamed)
        for (const Step& step : steps_) stays_[step.stray] = true;
      surface_ = before;
    }
  }

 private:
  struct Step {
    Vertex stray;
    Vertex into;  // a neighbour; -1: it goes to its target
    Vertex at() const { return into < 0 ? stray : into; }
  };

  void settle_apart() {
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
    std::erase_if(surface_.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  }

  void take(const Step& step, const std::vector<std::int32_t>& around) {
    if (step.into < 0)
      surface_.points[step.stray] = targets_[step.stray];
    else
      for (const std::int32_t t : around)
        std::replace(surface_.triangles[t].begin(), surface_.triangles[t].end(), step.stray, step.into);
  }

  std::optional<Step> best_step(Vertex v, const std::vector<Vertex>& ring, const TrianglesAround& around) const {
    double least = misfit(v, -1, surface_.points[v], around[v]);
    std::optional<Step> best;
    const auto consider = [&](const Step& step, const Vec3& place) {
      if (!keeps_sides(v, step.into, place, around[v])) return;
      if (const double found = misfit(v, step.into, place, around[v]); found < least) least = found, best = step;
    };
    consider({v, -1}, targets_[v]);
    for (const Vertex w : ring)
      if (!is_stray_[w] && links_allow(v, w, around)) consider({v, w}, surface_.points[w]);
    return best;
  }

  // On a closed surface an edge may be merged when its ends have two neighbours in common, those opposite it.
  bool links_allow(Vertex v, Vertex w, const TrianglesAround& around) const {
    const auto a = neighbours(surface_, around[v], v), b = neighbours(surface_, around[w], w);
    std::vector<Vertex> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    return common.size() == 2 && a.size() > 3;
  }

  // Calls visit(before, after) with the corners of each triangle around a point that goes to `place`, but for those
  // that have `into` and so vanish.
  template <class Visit>
  void for_each_changed(Vertex v, Vertex into, const Vec3& place, const std::vector<std::int32_t>& around,
                        Visit&& visit) const {
    for (const std::int32_t t : around) {
      const Triangle& triangle = surface_.triangles[t];
      if (into >= 0 && has(triangle, into)) continue;
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

  // How far middles of triangles and edges are from the input at most.
  double misfit(Vertex v, Vertex into, const Vec3& place, const std::vector<std::int32_t>& around) const {
    double greatest = 0;
    for_each_changed(v, into, place, around, [&](const auto&, const auto& at) {
      greatest = std::max(greatest, input_.distance((1.0 / 3) * (at[0] + at[1] + at[2])));
      for (std::size_t i = 0; i < 3; ++i)
        greatest = std::max(greatest, input_.distance(0.5 * (at[i] + at[(i + 1) % 3])));
    });
    return greatest;
  }

  Surface& surface_;
  std::vector<char>& is_stray_;
  const std::vector<Vec3>& targets_;
  const TriangleTree& input_;
  std::vector<char> stays_;
  std::vector<Step> steps_;
};

}  // namespace

void settle_strays(Surface& surface, std::vector<char>& is_stray, const std::vector<Vec3>& targets,
                   const TriangleTree& input) {
  StraySettler settler(surface, is_stray, targets, input);
  while (settler.round()) {
  }
}

}  // namespace hexpipe::wrap
