#pragma once
// The steps from one point of a lattice to the next, as a node sees them by the distances to its neighbours, and
// vectors counted in such steps.

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <optional>

#include "common/mesh/vec3.hpp"

namespace hexpipe::tetmesh::fields {

// How strongly steps keep to the field, relative to all links.
inline constexpr double rigidity = 0.1;

// The least-squares solution for the gradients of a lattice's K coordinates at a node.
template <int K>
class StepFit {
 public:
  using Vector = Eigen::Matrix<double, K, 1>;
  using Matrix = Eigen::Matrix<double, K, K>;  // a column for each axis

  // From a neighbour it is `way` to the node, in sizes, and `distance` in the lattice.
  void add(double weight, const Vector& way, const std::array<double, static_cast<std::size_t>(K)>& distance) {
    moments_ += weight * way * way.transpose();
    right_ += weight * way * Eigen::Map<const Eigen::Matrix<double, 1, K>>(distance.data());
  }
  // Pulls the gradients to the field's axes.
  void hold(double weight, const Matrix& axes) {
    moments_ += weight * Matrix::Identity();
    right_ += weight * axes;
  }
  double moment() const { return moments_.trace(); }

  // In sizes. Nothing where the lattice nearly folds, or where it turns over and may not be mirrored: steps follow the
  // field there.
  std::optional<Matrix> steps(bool may_be_mirrored) const {
    const Matrix gradients = moments_.inverse() * right_;
    const double determinant = gradients.determinant();
    if (!((may_be_mirrored ? std::abs(determinant) : determinant) > least_determinant)) return std::nullopt;
    return gradients.transpose().inverse();
  }

 private:
  // The determinant of the gradients: in lattice cells per square or cube of the size.
  static constexpr double least_determinant = 0.2;

  Matrix moments_ = Matrix::Zero(), right_ = Matrix::Zero();
};

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

}  // namespace hexpipe::tetmesh::fields
