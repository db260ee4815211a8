#include "tools/tetmesh/sizing/size_field.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"

namespace hexpipe::tetmesh::sizing {
namespace {

constexpr std::size_t most_corners = 4;

// Sizes at the corners of a simplex.
struct SizeSimplex {
  std::array<Vec3, most_corners> corners;
  std::array<double, most_corners> sizes;
  std::size_t count = 0;

  void add(const Vec3& corner, double size) {
    corners[count] = corner;
    sizes[count++] = size;
  }
  SizeSimplex without(std::size_t corner) const {
    SizeSimplex facet;
    for (std::size_t i = 0; i < count; ++i)
      if (i != corner) facet.add(corners[i], sizes[i]);
    return facet;
  }
};

// Solves a positive definite system of up to three unknowns. is_regular() is false where the system is singular.
class SmallSystem {
 public:
  static constexpr std::size_t most = most_corners - 1;
  using Column = std::array<double, most>;

  explicit SmallSystem(std::span<const Vec3> edges) : count_(edges.size()) {
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = dot(edges[i], edges[j]);
        for (std::size_t k = 0; k < j; ++k) sum -= lower_[i][k] * lower_[j][k];
        if (i > j)
          lower_[i][j] = sum / lower_[j][j];
        else if (sum > least_pivot * norm_squared(edges[i]))
          lower_[i][i] = std::sqrt(sum);
        else
          regular_ = false, lower_[i][i] = 1;
      }
  }

  bool is_regular() const { return regular_; }

  Column solve(const Column& right) const {
    Column x = right;
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t k = 0; k < i; ++k) x[i] -= lower_[i][k] * x[k];
      x[i] /= lower_[i][i];
    }
    for (std::size_t i = count_; i-- > 0;) {
      for (std::size_t k = i + 1; k < count_; ++k) x[i] -= lower_[k][i] * x[k];
      x[i] /= lower_[i][i];
    }
    return x;
  }

 private:
  static constexpr double least_pivot = 1e-12;

  std::size_t count_;
  bool regular_ = true;
  std::array<Column, most> lower_{};  // the Cholesky factor
};

// The least of size(y) + grading |p - y| over y in the simplex. The function is convex. In the plane of the simplex it
// is least where the direction to p makes the angle with the plane that the gradient of the sizes asks for. When that
// place is outside the simplex, the least value is on a facet that separates the simplex from it.
double least_over(const SizeSimplex& simplex, const Vec3& p, double grading) {
  const Vec3 to_p = p - simplex.corners[0];
  if (simplex.count == 1) return simplex.sizes[0] + grading * norm(to_p);
  const std::size_t count = simplex.count - 1;
  std::array<Vec3, SmallSystem::most> edges;
  SmallSystem::Column rise{}, along{};
  for (std::size_t i = 0; i < count; ++i) {
    edges[i] = simplex.corners[i + 1] - simplex.corners[0];
    rise[i] = simplex.sizes[i + 1] - simplex.sizes[0];
    along[i] = dot(edges[i], to_p);
  }
  const SmallSystem system{std::span<const Vec3>(edges).first(count)};
  const SmallSystem::Column foot = system.solve(along), gradient = system.solve(rise);
  double slope_squared = 0, height_squared = count == 3 ? 0 : norm_squared(to_p), size = simplex.sizes[0];
  for (std::size_t i = 0; i < count; ++i) {
    slope_squared += rise[i] * gradient[i];
    if (count < 3) height_squared -= along[i] * foot[i];
    size += rise[i] * foot[i];
  }
  const double steepness = std::sqrt(std::max(0.0, grading * grading - slope_squared));
  std::array<bool, most_corners> behind{};  // for each facet: whether the least value may be on it
  if (system.is_regular() && steepness > 0) {
    const double height = std::sqrt(std::max(0.0, height_squared));
    double rest = 1;
    for (std::size_t i = 0; i < count; ++i) {
      const double weight = foot[i] - gradient[i] * height / steepness;
      behind[i + 1] = weight < 0;
      rest -= weight;
    }
    behind[0] = rest < 0;
    if (std::ranges::none_of(behind, std::identity())) return size + height * steepness;
  } else {
    behind.fill(true);
  }
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < simplex.count; ++i)
    if (behind[i]) least = std::min(least, least_over(simplex.without(i), p, grading));
  return least;
}

// A prism, prepared to measure its distance from many points.
class PrismDistance {
 public:
  explicit PrismDistance(const SizePrism& prism)
      : base_(prism.corners[0], prism.corners[1], prism.corners[2]),
        corner_(prism.corners[0]),
        up_(unit(prism.across)),
        height_(norm(prism.across)) {}

  double from(const Vec3& p) const {
    const double above = std::clamp(dot(p - corner_, up_), 0.0, height_);
    return std::sqrt(base_.squared(p - above * up_));
  }

 private:
  geometry::TriangleDistance base_;
  Vec3 corner_, up_;
  double height_;
};

}  // namespace

struct SizeField::Known {
  Known(SizeSources known_sources, double limit)
      : sources(std::move(known_sources)), grading(limit), tree(tree_of(sources)) {
    distances.reserve(sources.prisms.size());
    for (const SizePrism& prism : sources.prisms) distances.emplace_back(prism);
  }

  // The size that a source allows at p; the source has this number in the tree.
  double size_by(std::size_t source, const Vec3& p) const {
    if (source < sources.simplices.size()) return least_over(simplex_of(sources, source), p, grading);
    const std::size_t prism = source - sources.simplices.size();
    return sources.prisms[prism].size + grading * distances[prism].from(p);
  }

  static SizeSimplex simplex_of(const SizeSources& sources, std::size_t number) {
    SizeSimplex simplex;
    for (const Vertex v : sources.simplices[number])
      if (v != no_index) simplex.add(sources.points[v], sources.sizes[v]);
    return simplex;
  }

  // Simplices come before prisms.
  static geometry::BoxTree tree_of(const SizeSources& sources) {
    std::vector<geometry::Box> boxes;
    std::vector<double> values;
    boxes.reserve(sources.simplices.size() + sources.prisms.size());
    values.reserve(boxes.capacity());
    for (std::size_t i = 0; i < sources.simplices.size(); ++i) {
      const SizeSimplex simplex = simplex_of(sources, i);
      boxes.push_back(geometry::Box::around(std::span(simplex.corners).first(simplex.count)));
      values.push_back(std::ranges::min(std::span(simplex.sizes).first(simplex.count)));
    }
    for (const auto& [corners, across, size] : sources.prisms) {
      geometry::Box box = geometry::Box::around(corners);
      box.add(geometry::Box::around(std::array{corners[0] + across, corners[1] + across, corners[2] + across}));
      boxes.push_back(box);
      values.push_back(size);
    }
    return {boxes, values};
  }

  SizeSources sources;
  double grading;
  geometry::BoxTree tree;
  std::vector<PrismDistance> distances;
};

SizeField::SizeField(SizeSources sources, double greatest, double grading) : greatest_(greatest), least_(greatest) {
  for (const auto& simplex : sources.simplices)
    for (const Vertex v : simplex)
      if (v != no_index) least_ = std::min(least_, sources.sizes[v]);
  for (const SizePrism& prism : sources.prisms) least_ = std::min(least_, prism.size);
  if (least_ < greatest_) known_ = std::make_shared<const Known>(std::move(sources), grading);
}

double SizeField::limited_at(const Vec3& p, double most) const {
  return known_->tree.least(p, known_->grading, most,
                            [&](std::int32_t number) { return known_->size_by(static_cast<std::size_t>(number), p); });
}

double SizeField::least_near(double here, double reach) const {
  return known_ ? std::max(least(), here - factor_ * known_->grading * reach) : greatest();
}

}  // namespace hexpipe::tetmesh::sizing
