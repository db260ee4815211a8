#include "tools/wrap/restoring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "tools/wrap/restoring_steps.hpp"
#include "tools/wrap/sharp_points.hpp"
#include "tools/wrap/shrink_wrap.hpp"

namespace hexpipe::wrap {
namespace {

Vec3 area_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return cross(b - a, c - a);
}

// A triangle that has this little of its area, or turns by more than this, would make slivers and folds.
constexpr double least_share_of_area = 0.02, least_cosine = 0.1;

bool keeps_its_side(const Vec3& before, const Vec3& after) {
  const double old_area = norm(before), new_area = norm(after);
  return new_area >= least_share_of_area * old_area && dot(before, after) >= least_cosine * old_area * new_area;
}

class Restorer {
 public:
  Restorer(const Surface& wrapped, const TriangleTree& input, const RestoreOptions& options)
      : wrapped_(wrapped),
        input_(input),
        reach_(options.reach),
        feature_angle_(options.feature_angle),
        sharp_points_(wrapped.triangles.size()),
        moves_(wrapped.points.size()),
        targets_(wrapped.points) {
    std::vector<Vec3> normals(wrapped.points.size());
    for (const auto& [a, b, c] : wrapped.triangles) {
      const Vec3 normal = area_normal(wrapped.points[a], wrapped.points[b], wrapped.points[c]);
      for (const Vertex v : {a, b, c}) normals[v] += normal;
    }
    planes_.reserve(wrapped.points.size());
    for (std::size_t v = 0; v < wrapped.points.size(); ++v) {
      targets_[v] = input.nearest(wrapped.points[v]).point;
      moves_[v] = norm(targets_[v] - wrapped.points[v]) <= options.reach;
      planes_.push_back({targets_[v], input.facing_plane(targets_[v], unit(normals[v]), 1e-6 * options.reach).normal});
    }
    keep_sides();
    find_sharp_points();
  }

  RestoredSurface run() {
    // Each round takes something back, and what crosses is local: few rounds do.
    for (;;) {
      build();
      const auto crossing = crossing_triangles(result_.surface);
      if (crossing.empty()) break;
      for (const std::int32_t t : crossing) take_back(result_.surface.triangles[t]);
      keep_sides();
    }
    tidy_up();
    leave_out_unused_points();
    return result_;
  }

 private:
  std::array<Vec3, 3> placed(const Triangle& t) const { return {place_of(t[0]), place_of(t[1]), place_of(t[2])}; }
  Vec3 place_of(Vertex v) const { return moves_[v] ? targets_[v] : wrapped_.points[v]; }
  Vec3 wrapped_normal(const Triangle& t) const {
    return area_normal(wrapped_.points[t[0]], wrapped_.points[t[1]], wrapped_.points[t[2]]);
  }

  // Corners of triangles that would fold stay where they are.
  void keep_sides() {
    for (bool changed = true; changed;) {
      changed = false;
      for (const Triangle& t : wrapped_.triangles) {
        const auto at = placed(t);
        if (keeps_its_side(wrapped_normal(t), area_normal(at[0], at[1], at[2]))) continue;
        for (const Vertex v : t) {
          changed = changed || moves_[v];
          moves_[v] = false;
        }
      }
    }
    for (std::size_t t = 0; t < wrapped_.triangles.size(); ++t)
      for (const Vertex v : wrapped_.triangles[t])
        if (!moves_[v]) sharp_points_[t].reset();
  }

  void find_sharp_points() {
    const SharpPointFinder finder(input_, feature_angle_);
    for (std::size_t t = 0; t < wrapped_.triangles.size(); ++t) {
      const Triangle& triangle = wrapped_.triangles[t];
      if (std::all_of(triangle.begin(), triangle.end(), [&](Vertex v) { return moves_[v]; }))
        sharp_points_[t] =
            finder.find(placed(triangle), {planes_[triangle[0]], planes_[triangle[1]], planes_[triangle[2]]});
    }
  }

  // Several points of the wrap may belong to one place of the input, as a corner: one goes there, and the others are in
  // its way. Sharp points that fall onto points of the wrap, or onto its edges, leave triangles of almost no area.
  // Where these are gone, more points find room.
  void tidy_up() {
    std::vector<char> is_stray(result_.surface.points.size());
    std::vector<Vec3> targets = result_.surface.points;
    for (std::size_t v = 0; v < wrapped_.points.size(); ++v) {
      const bool spans_gap = norm(targets_[v] - wrapped_.points[v]) > reach_;
      is_stray[v] = !moves_[v] && !spans_gap;
      targets[v] = targets_[v];
    }
    const double shortest = 0.03 * reach_;
    for (int round = 0; round < 2; ++round) {
      mend_cut_edges(result_.surface, input_, {feature_angle_, 0.003 * reach_, 0.2 * reach_, shortest});
      const std::size_t count = result_.surface.points.size();
      for (std::size_t v = targets.size(); v < count; ++v) targets.push_back(result_.surface.points[v]);
      owner_of_point_.resize(count, no_index);
      is_stray.resize(count);
      for (std::size_t v = 0; v < count; ++v) is_stray[v] = is_stray[v] && !is_on_input(v);
      settle_strays(result_.surface, is_stray, targets, input_);
      flip_what_cuts_edges();
      result_.slivers = remove_slivers(result_.surface, input_, {shortest, 0.05 * reach_});
    }
    std::vector<char> is_used(result_.surface.points.size());
    for (const Triangle& t : result_.surface.triangles)
      for (const Vertex v : t) is_used[v] = true;
    for (std::size_t v = 0; v < is_used.size(); ++v)
      if (is_used[v]) ++(is_on_input(v) ? result_.points_on_input : result_.points_off_input);
  }

  bool is_on_input(std::size_t v) const { return input_.distance(result_.surface.points[v]) <= 1e-6 * reach_; }

  void leave_out_unused_points() {
    auto& [points, triangles] = result_.surface;
    std::vector<Vertex> number(points.size(), no_index);
    std::vector<Vec3> used;
    for (Triangle& t : triangles)
      for (Vertex& v : t) {
        if (number[v] == no_index) number[v] = static_cast<Vertex>(used.size()), used.push_back(points[v]);
        v = number[v];
      }
    points = std::move(used);
  }

  void build() {
    result_ = {};
    Surface& surface = result_.surface;
    for (std::size_t v = 0; v < wrapped_.points.size(); ++v) surface.points.push_back(place_of(static_cast<Vertex>(v)));
    owner_of_point_.assign(wrapped_.points.size(), no_index);
    for (std::size_t t = 0; t < wrapped_.triangles.size(); ++t) {
      const auto [a, b, c] = wrapped_.triangles[t];
      if (!sharp_points_[t]) {
        surface.triangles.push_back({a, b, c});
        continue;
      }
      const auto s = static_cast<Vertex>(surface.points.size());
      surface.points.push_back(*sharp_points_[t]);
      owner_of_point_.push_back(static_cast<std::int32_t>(t));
      for (const Triangle& third : {Triangle{a, b, s}, Triangle{b, c, s}, Triangle{c, a, s}})
        surface.triangles.push_back(third);
      ++result_.sharp_points;
    }
    flip_to_input(false);
  }

  // Edges give way to the other diagonal where that lies nearer to the input: so points on one sharp edge come
  // together. At first only those at sharp points, because what was no edge of the wrap and joins none is as good as
  // any other diagonal.
  void flip_to_input(bool everywhere) {
    auto& [points, triangles] = result_.surface;
    for (int round = 0; round < 3; ++round) {
      std::unordered_map<std::uint64_t, std::int32_t> triangle_of;  // by directed edge
      const auto key = [](Vertex from, Vertex to) {
        return std::uint64_t(std::uint32_t(from)) << 32 | std::uint32_t(to);
      };
      for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int i = 0; i < 3; ++i)
          triangle_of[key(triangles[t][i], triangles[t][(i + 1) % 3])] = static_cast<std::int32_t>(t);
      const std::size_t count = triangles.size();
      bool changed = false;
      std::vector<char> touched(count);
      for (std::size_t t = 0; t < count; ++t)
        for (int i = 0; i < 3 && !touched[t]; ++i) {
          const Vertex u = triangles[t][i], v = triangles[t][(i + 1) % 3], s = triangles[t][(i + 2) % 3];
          const auto found = triangle_of.find(key(v, u));
          if (u > v || found == triangle_of.end() || touched[found->second]) continue;
          const std::int32_t other = found->second;
          Triangle& beyond = triangles[other];
          const Vertex w = opposite(beyond, u, v);
          if (!everywhere && owner_of_point_[s] == no_index && owner_of_point_[w] == no_index) continue;
          if (!keeps_edges_.empty() && (keeps_edges_[u] || keeps_edges_[v] || keeps_edges_[s] || keeps_edges_[w]))
            continue;
          if (triangle_of.contains(key(s, w)) || triangle_of.contains(key(w, s)) || !pays(u, v, s, w)) continue;
          touched[t] = touched[other] = true;
          triangles[t] = {s, w, v};
          beyond = {w, s, u};
          triangle_of[key(s, w)] = static_cast<std::int32_t>(t);
          triangle_of[key(w, s)] = other;
          changed = true;
        }
      if (!changed) return;
    }
  }

  // Points that came to a sharp edge late are joined along it. Where the surface would cross itself edges stay.
  void flip_what_cuts_edges() {
    const std::vector<Triangle> before = result_.surface.triangles;
    keeps_edges_.assign(result_.surface.points.size(), false);
    for (;;) {
      flip_to_input(true);
      const auto crossing = crossing_triangles(result_.surface);
      if (crossing.empty()) return;
      for (const std::int32_t t : crossing)
        for (const Vertex v : result_.surface.triangles[t]) keeps_edges_[v] = true;
      result_.surface.triangles = before;
    }
  }

  static Vertex opposite(const Triangle& t, Vertex u, Vertex v) {
    for (const Vertex w : t)
      if (w != u && w != v) return w;
    return no_index;
  }

  bool pays(Vertex u, Vertex v, Vertex s, Vertex w) const {
    const auto& p = result_.surface.points;
    const double now = input_.distance(0.5 * (p[u] + p[v]));
    if (now < 1e-3 * norm(p[u] - p[v]) || input_.distance(0.5 * (p[s] + p[w])) > 0.5 * now) return false;
    const Vec3 side = unit(area_normal(p[u], p[v], p[s])) + unit(area_normal(p[v], p[u], p[w]));
    const Vec3 first = area_normal(p[s], p[w], p[v]), second = area_normal(p[w], p[s], p[u]);
    const double least_area = 1e-4 * norm_squared(p[s] - p[w]);
    return norm(first) > least_area && norm(second) > least_area && dot(first, side) > 0 && dot(second, side) > 0;
  }

  // A sharp point if there is one, otherwise the way to the input.
  void take_back(const Triangle& t) {
    bool sharp = false;
    for (const Vertex v : t)
      if (const std::int32_t owner = owner_of_point_[v]; owner != no_index) sharp_points_[owner].reset(), sharp = true;
    if (sharp) return;
    for (const Vertex v : t) moves_[v] = false;
  }

  const Surface& wrapped_;
  const TriangleTree& input_;
  double reach_, feature_angle_;
  std::vector<std::optional<Vec3>> sharp_points_;  // of each triangle of the wrap
  std::vector<char> moves_;                        // each point of the wrap: to its target
  std::vector<Vec3> targets_;
  std::vector<Plane> planes_;  // of the input, at the targets
  RestoredSurface result_;
  std::vector<char> keeps_edges_;             // points whose edges may not flip; empty: none
  std::vector<std::int32_t> owner_of_point_;  // for a sharp point, the triangle of the wrap in which it stands
};

}  // namespace

RestoredSurface restore_shape(const Surface& wrapped, const TriangleTree& input, const RestoreOptions& options) {
  return Restorer(wrapped, input, options).run();
}

}  // namespace hexpipe::wrap
