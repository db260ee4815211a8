// An octree over the box around the model: a cell is halved while a size within it asks for a finer lattice. Every cell
// owns the lattice point at its lowest corner, so a point of a finer lattice is met only once, in the cell that was
// made for it.

#include "tools/tetmesh/volume/lattice.hpp"

#include <algorithm>
#include <cmath>

#include "common/run/error.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/solid/surface_clearance.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

// Steps are at most 2 to this power times the size, and at least half of that: 0.87 times the size on average.
constexpr double level_bias = 0.3;
constexpr int most_levels = 20;
constexpr double most_roots = 1e8;

class GradedLattice {
 public:
  GradedLattice(const solid::Surface& surface, const sizing::SizeField& size, const LatticeOptions& options,
                double most_points)
      : surface_(surface), size_(size), options_(options), most_points_(most_points), clearance_(surface) {
    geometry::Box box = geometry::Box::around(std::array{in_axes(surface.points.front())});
    for (const Vec3& p : surface.points) box.add({in_axes(p), in_axes(p)});
    low_ = box.low;
    const Vec3 extent = box.high - box.low;
    outermost_ = std::min(options_.size, std::max({extent.x, extent.y, extent.z}));
    for (int axis = 0; axis < 3; ++axis) {
      counts_[axis] = std::max(1.0, std::round(extent[axis] / outermost_));
      steps_[axis] = extent[axis] / counts_[axis];
      // Where the model is thinner than the outermost step, its one step along the axis is already that of a finer
      // lattice.
      whole_levels_[axis] = std::max(0, static_cast<int>(std::round(std::log2(outermost_ / steps_[axis]))));
    }
  }

  std::vector<Vec3> points_inside() {
    if (counts_[0] * counts_[1] * counts_[2] > most_roots)
      throw DataError::at(surface_.name, "expected a size of which the bounding box holds at most {:g}, found {:g}",
                          most_roots, options_.size);
    const auto count = [&](int axis) { return static_cast<int>(counts_[axis]); };
    for (int k = 0; k < count(2); ++k)
      for (int j = 0; j < count(1); ++j)
        for (int i = 0; i < count(0); ++i)
          visit({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}, 0, true);
    return std::move(points_);
  }

 private:
  Vec3 in_axes(const Vec3& p) const {
    return {dot(p, options_.axes[0]), dot(p, options_.axes[1]), dot(p, options_.axes[2])};
  }
  // The widths of a cell, in steps of the outermost lattice.
  Vec3 widths_at(int level) const {
    const auto width = [&](int axis) { return std::exp2(-std::max(0, level - whole_levels_[axis])); };
    return {width(0), width(1), width(2)};
  }
  // The place of lattice coordinates, in steps of the outermost lattice.
  Vec3 place_of(const Vec3& c) const {
    const Vec3 in_frame = low_ + Vec3{c.x * steps_[0], c.y * steps_[1], c.z * steps_[2]};
    return in_frame.x * options_.axes[0] + in_frame.y * options_.axes[1] + in_frame.z * options_.axes[2];
  }
  int level_for(double size) const {
    const double halvings = std::log2(outermost_ / size) - level_bias;
    return static_cast<int>(std::clamp(std::ceil(halvings), 0.0, static_cast<double>(most_levels)));
  }

  void visit(const Vec3& corner, int level, bool is_new);
  void take(const Vec3& p, int level);

  const solid::Surface& surface_;
  const sizing::SizeField& size_;
  const LatticeOptions& options_;
  double most_points_;
  solid::SurfaceClearance clearance_;
  Vec3 low_;
  double outermost_;  // the size of the outermost lattice: the greatest, or the length of the model
  std::array<double, 3> counts_{}, steps_{};
  std::array<int, 3> whole_levels_{};  // along each axis, the first level at which cells are not halved
  std::vector<Vec3> points_;
};

// `is_new`: the corner is not a point of a coarser lattice.
void GradedLattice::visit(const Vec3& corner, int level, bool is_new) {
  if (is_new) take(place_of(corner), level);
  const Vec3 widths = widths_at(level), halves = widths_at(level + 1);
  const Vec3 centre = place_of(corner + 0.5 * widths);
  const double reach = 0.5 * norm(Vec3{widths.x * steps_[0], widths.y * steps_[1], widths.z * steps_[2]});
  if (level_for(size_.least_near(size_.at(centre), reach)) <= level) return;
  for (int child = 0; child < 8; ++child) {
    const Vec3 offset{child & 1 ? halves.x : 0, child & 2 ? halves.y : 0, child & 4 ? halves.z : 0};
    const bool is_there = offset.x < widths.x && offset.y < widths.y && offset.z < widths.z;
    if (is_there) visit(corner + offset, level + 1, child != 0);
  }
}

void GradedLattice::take(const Vec3& p, int level) {
  const double size = size_.at(p);
  if (level_for(size) < level || !clearance_.is_clear(p, options_.clearance * size) || !clearance_.is_inside(p)) return;
  if (static_cast<double>(points_.size()) >= most_points_)
    throw DataError::at(surface_.name,
                        "expected sizes that make at most {:g} points inside (see --most-points), found {:g} to {:g}, "
                        "which make more",
                        most_points_, size_.least(), size_.greatest());
  points_.push_back(p + jitter_of(points_.size(), options_.jitter * size, options_.seed));
}

}  // namespace

std::vector<Vec3> graded_lattice_points(const solid::Surface& surface, const sizing::SizeField& size,
                                        LatticeOptions options, double most_points) {
  options.size = size.greatest();
  if (size.is_uniform()) return lattice_points(surface, options);
  return GradedLattice(surface, size, options, most_points).points_inside();
}

}  // namespace hexpipe::tetmesh::volume
