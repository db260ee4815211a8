#include "tools/tetmesh/volume/row_guide.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "tools/tetmesh/fields/lattice_steps.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"
#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

// Nodes within this many sizes are asked; 1 and 1.5 are as good.
constexpr double reach_of_guide = 1.2;
// The normals of a smooth node and of the place differ by less: the node is not on the other side of a wall.
constexpr double same_side_cosine = 0.7;

using Numbers = std::array<fields::Complex, 2>;

// Which axes of a frame two directions are, and whether they point the same way.
struct AxesOfDirections {
  std::array<std::size_t, 2> axis{};
  std::array<double, 2> cosine{};

  AxesOfDirections(const fields::Frame& frame, const std::array<Vec3, 2>& directions) {
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t a = 0; a < 3; ++a) {
        const double c = dot(frame[a], directions[k]);
        if (std::abs(c) <= std::abs(cosine[k])) continue;
        cosine[k] = c;
        axis[k] = a;
      }
  }
  double trust() const {
    return axis[0] == axis[1] ? 0 : surface::trust_in_match((std::abs(cosine[0]) + std::abs(cosine[1])) / 2);
  }
};

class GuideAtNodes {
 public:
  GuideAtNodes(const FieldNodes& nodes, const std::vector<fields::Frame>& frames, const LatticeField& lattice,
               const sizing::SizeField& size)
      : nodes_(nodes), frames_(frames), lattice_(lattice), size_(size), grid_(nodes.points.front()) {
    in_steps_.reserve(nodes.surface.size());
    for (std::size_t i = 0; i < nodes.surface.size(); ++i) {
      grid_.add(nodes.points[i], nodes.sizes[i]);
      in_steps_.emplace_back(lattice.steps[i]);
    }
  }

  // The mean of what the nodes around the place see there, the nearest above all. It is short where they disagree.
  Numbers at(const Vec3& place, const Vec3& normal, const std::array<Vec3, 2>& directions) const {
    Numbers sum{};
    double total = 0;
    const double size = size_.at(place), reach = reach_of_guide * size;
    grid_.for_each_near(place, reach, size_.least_near(size, reach), [&](std::int32_t i) {
      const SurfaceNode& node = nodes_.surface[i];
      const double nearness = 1 - norm(place - nodes_.points[i]) / reach;
      if (nearness <= 0) return true;
      if (node.kind == SurfaceNode::Kind::smooth && dot(node.normal, normal) < same_side_cosine) return true;
      total += nearness;
      const AxesOfDirections axes(frames_[i], directions);
      const double weight = nearness * axes.trust();
      if (weight <= 0) return true;
      const Vec3 coordinates = coordinates_at(place, size, i);
      for (std::size_t k = 0; k < 2; ++k) {
        const double along = coordinates[static_cast<int>(axes.axis[k])];
        sum[k] += weight * fields::number_at(axes.cosine[k] < 0 ? -along : along);
      }
      return true;
    });
    for (fields::Complex& number : sum) number = total > 0 ? number / total : number;
    return sum;
  }

 private:
  // The lattice's coordinates at a place of that size, by the steps at a node.
  Vec3 coordinates_at(const Vec3& place, double size, std::int32_t i) const {
    const Vec3 way = (2 / (nodes_.sizes[i] + size)) * (place - nodes_.points[i]);
    const auto& here = lattice_.coordinates[i];
    return Vec3{here[0], here[1], here[2]} + in_steps_[i](way);
  }

  const FieldNodes& nodes_;
  const std::vector<fields::Frame>& frames_;
  const LatticeField& lattice_;
  const sizing::SizeField& size_;
  geometry::SizedPointGrid grid_;          // of the nodes on the surface
  std::vector<fields::InSteps> in_steps_;  // of these
};

}  // namespace

CoordinatesOnSurface coordinates_on_surface(const FieldNodes& nodes, const std::vector<fields::Frame>& frames,
                                            const LatticeField& lattice, const sizing::SizeField& size) {
  const auto guide = std::make_shared<const GuideAtNodes>(nodes, frames, lattice, size);
  return [guide](const Vec3& place, const Vec3& normal, const std::array<Vec3, 2>& directions) {
    return guide->at(place, normal, directions);
  };
}

}  // namespace hexpipe::tetmesh::volume
