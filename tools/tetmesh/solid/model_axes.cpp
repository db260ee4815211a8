// Normals of nearly the same or the opposite direction are put together, with their areas. Two such directions at right
// angles make a frame, which is judged by the area at right angles to its axes. If a direction has no partner, feature
// edges take the place of the second direction.

#include "tools/tetmesh/solid/model_axes.hpp"

#include <algorithm>
#include <cmath>

#include "tools/tetmesh/geometry/half_edges.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

constexpr Axes coordinate_axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
// Directions within 0.1 degrees count as one. Over that angle a lattice of 500 steps leaves a face by one step.
constexpr double same_cosine = 1 - 1.5e-6, right_angle_cosine = 1.7e-3;
// The number of directions that are tried. The areas fall quickly behind the first ones.
constexpr std::size_t most_directions = 24;
// Another frame must have this share of the surface more than the coordinate axes have. An edge of length l counts as
// an area of l times this share of the longest edge.
constexpr double least_gain = 0.01, edge_weight = 0.01;

struct Direction {
  Vec3 sum;  // of the normals, all turned to one side, by area
  double weight = 0;

  Vec3 mean() const { return unit(sum); }
};

// Directions up to their sign, the heaviest first.
class DirectionList {
 public:
  // The vectors are sorted by their weight, so that the first vector of a direction is the heaviest.
  explicit DirectionList(std::vector<Vec3> vectors) {
    std::ranges::stable_sort(vectors, std::ranges::greater(), [](const Vec3& v) { return norm_squared(v); });
    for (const Vec3& v : vectors) add(v);
    std::ranges::stable_sort(directions_, std::ranges::greater(), &Direction::weight);
  }

  const std::vector<Direction>& directions() const { return directions_; }

 private:
  void add(const Vec3& v) {
    const double weight = norm(v);
    if (!(weight > 0)) return;
    for (Direction& d : directions_) {
      const double cosine = dot(d.sum, v) / (weight * norm(d.sum));
      if (std::abs(cosine) < same_cosine) continue;
      d.sum += cosine > 0 ? v : -v;
      d.weight += weight;
      return;
    }
    // Vectors that come late are the many small ones of curved faces.
    if (directions_.size() < most_kept) directions_.push_back({v, weight});
  }

  static constexpr std::size_t most_kept = 128;
  std::vector<Direction> directions_;
};

class AxesFinder {
 public:
  AxesFinder(const Surface& surface, double feature_angle)
      : surface_(surface), faces_(area_normals()), edges_(feature_edges(cosine_of_degrees(feature_angle))) {}

  Axes find() const {
    const auto candidates = std::span(faces_.directions()).first(std::min(faces_.directions().size(), most_directions));
    Axes best = coordinate_axes;
    double most = score(coordinate_axes) + least_gain * total_area_;
    for (const Direction& first : candidates) {
      if (3 * first.weight < most) break;  // a frame of lesser faces cannot have more
      for (const DirectionList* list : {&faces_, &edges_})
        for (const Direction& second : list->directions()) {
          const Vec3 a = first.mean(), b = second.mean();
          if (std::abs(dot(a, b)) > right_angle_cosine) continue;
          const Axes axes = frame_of(a, b);
          if (const double s = score(axes); s > most) {
            most = s;
            best = axes;
          }
        }
    }
    return best == coordinate_axes ? best : nearest_to_coordinates(refined(best));
  }

 private:
  std::vector<Vec3> area_normals() {
    std::vector<Vec3> normals;
    normals.reserve(surface_.triangles.size());
    for (const auto& [a, b, c] : surface_.triangles) {
      normals.push_back(0.5 * cross(surface_.points[b] - surface_.points[a], surface_.points[c] - surface_.points[a]));
      total_area_ += norm(normals.back());
    }
    return normals;
  }

  // The lengths are weighted so that all edges together count little beside the surface.
  std::vector<Vec3> feature_edges(double feature_cosine) const {
    std::vector<Vec3> edges;
    double total = 0;
    geometry::for_each_edge(surface_.points.size(), surface_.triangles, [&](std::span<const geometry::HalfEdge> edge) {
      // The free border of a baffle has a single triangle, whose direction counts like a sharp edge's.
      const Vec3 n = area_normal(geometry::triangle_of(edge[0]));
      const Vec3 m = edge.size() > 1 ? area_normal(geometry::triangle_of(edge[1])) : -n;
      if (dot(n, m) > feature_cosine * norm(n) * norm(m)) return;
      edges.push_back(surface_.points[geometry::end_of(surface_.triangles, edge[0])] -
                      surface_.points[geometry::start_of(surface_.triangles, edge[0])]);
      total += norm(edges.back());
    });
    for (Vec3& edge : edges) edge = edge * (edge_weight * total_area_ / total);
    return edges;
  }

  Vec3 area_normal(std::int32_t triangle) const {
    const auto& [a, b, c] = surface_.triangles[triangle];
    return cross(surface_.points[b] - surface_.points[a], surface_.points[c] - surface_.points[a]);
  }

  static Axes frame_of(const Vec3& a, const Vec3& b) {
    const Vec3 third = unit(cross(a, b));
    return {a, cross(third, a), third};
  }

  static bool is_along(const Direction& d, const Vec3& axis) {
    const double cosine = dot(d.sum, axis);
    return cosine * cosine > same_cosine * same_cosine * norm_squared(d.sum);
  }

  // The area at right angles to the axes, and a little for the edges along them.
  double score(const Axes& axes) const {
    double sum = 0;
    for (const DirectionList* list : {&faces_, &edges_})
      for (const Direction& d : list->directions())
        if (std::ranges::any_of(axes, [&](const Vec3& axis) { return is_along(d, axis); })) sum += d.weight;
    return sum;
  }

  // All faces along the axes contribute, not only the two that the frame was made from.
  Axes refined(const Axes& axes) const {
    Axes sums{};
    std::array<double, 3> weights{};
    for (std::size_t i = 0; i < 3; ++i)
      for (const Direction& d : faces_.directions()) {
        if (!is_along(d, axes[i])) continue;
        sums[i] += dot(d.sum, axes[i]) > 0 ? d.sum : -d.sum;
        weights[i] += d.weight;
      }
    std::array<std::size_t, 3> order{0, 1, 2};
    std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return weights[i]; });
    const auto summed = [&](std::size_t i) { return weights[i] > 0 ? unit(sums[i]) : axes[i]; };
    return frame_of(summed(order[0]), summed(order[1]));
  }

  // The same axes, with the order and the signs that turn the coordinate axes least.
  static Axes nearest_to_coordinates(const Axes& axes) {
    Axes nearest = axes;
    double most = -1;
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
      double sum = 0;
      for (std::size_t i = 0; i < 3; ++i) sum += std::abs(axes[order[i]][static_cast<int>(i)]);
      if (sum <= most) continue;
      most = sum;
      for (std::size_t i = 0; i < 3; ++i) nearest[i] = axes[order[i]];
    } while (std::ranges::next_permutation(order).found);
    for (std::size_t i = 0; i < 2; ++i)
      if (nearest[i][static_cast<int>(i)] < 0) nearest[i] = -nearest[i];
    nearest[2] = cross(nearest[0], nearest[1]);
    return nearest;
  }

  const Surface& surface_;
  double total_area_ = 0;
  DirectionList faces_, edges_;
};

}  // namespace

Axes axes_of_model(const Surface& surface, double feature_angle) {
  return AxesFinder(surface, feature_angle).find();
}

}  // namespace hexpipe::tetmesh::solid
