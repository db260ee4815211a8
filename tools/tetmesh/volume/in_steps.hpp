#pragma once
// Vectors counted in the steps of a lattice.

#include <Eigen/Dense>
#include <array>

#include "common/mesh/vec3.hpp"

namespace hexpipe::tetmesh::volume {

// Counts the steps along each axis that lead as far as a vector.
class InSteps {
 public:
  explicit InSteps(const std::array<Vec3, 3>& steps) {
    Eigen::Matrix3d columns;
    for (std::size_t k = 0; k < 3; ++k) columns.col(static_cast<Eigen::Index>(k)) << steps[k].x, steps[k].y, steps[k].z;
    inverse_ = columns.inverse();
  }
  Vec3 operator()(const Vec3& way) const {
    const Eigen::Vector3d count = inverse_ * Eigen::Vector3d(way.x, way.y, way.z);
    return {count[0], count[1], count[2]};
  }

 private:
  Eigen::Matrix3d inverse_;
};

}  // namespace hexpipe::tetmesh::volume
