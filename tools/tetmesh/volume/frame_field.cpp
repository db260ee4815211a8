#include "tools/tetmesh/volume/frame_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/run/parallel.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

// Against all links of the node together. From 0.3 to 3, the share of the volume in hexes differs by 0.2 %.
constexpr double suggestion_weight = 0.3;
constexpr double normal_weight = 3;
// How strongly frames are held while they diffuse, against all links of the node together: little at first, so that far
// ones reach each other, and more each time.
constexpr std::array<double, 10> holds = {3e-4, 6.5e-4, 1.4e-3, 3e-3, 6.5e-3, 0.014, 0.03, 0.065, 0.14, 0.3};
constexpr int frame_sweeps = 4;
// The weight of a node's own frame against its links when frames are smoothed: plain means of neighbours may oscillate.
constexpr double inertia = 0.5;

using Field = Eigen::Matrix<double, 9, Eigen::Dynamic>;
using Kind = SurfaceNode::Kind;

// The two directions in which the function of a frame changes when the frame turns about its normal.
struct Turning {
  fields::Harmonics first, second;

  explicit Turning(const Vec3& normal) {
    constexpr double cosine = 0.92387953251128674, sine = 0.38268343236508977;  // of 22.5 degrees
    const fields::Frame frame = fields::frame_around(normal);
    first = fields::harmonics_of_cross(normal, frame[1]) / fields::cross_norm;
    second = fields::harmonics_of_cross(normal, cosine * frame[1] + sine * frame[2]) / fields::cross_norm;
  }
  fields::Harmonics part_of(const fields::Harmonics& a) const { return first * first.dot(a) + second * second.dot(a); }
};

class FrameSolver {
 public:
  explicit FrameSolver(const FieldNodes& nodes)
      : nodes_(nodes),
        count_(static_cast<std::int64_t>(nodes.size())),
        field_(Field::Zero(9, count_)),
        degree_(count_),
        frames_(nodes.size()) {}

  std::vector<fields::Frame> solve() {
    prepare();
    diffuse(0);
    project();
    for (const double hold : holds) {
      diffuse(hold);
      project();
    }
    for (int i = 0; i < frame_sweeps; ++i) sweep();
    return std::move(frames_);
  }

 private:
  void prepare();
  double suggestion_weight_of(std::size_t node) const;
  Field apply(const Field& x, double hold) const;
  Field residual() const;
  void restrict_to_freedom(Field& x) const;
  void diffuse(double hold);
  void project();
  void sweep();
  void lay_on_normal(std::size_t node);

  const FieldNodes& nodes_;
  std::int64_t count_;
  Field field_;
  Eigen::RowVectorXd degree_;  // sum of the weights of a node's links
  std::vector<Turning> turnings_;
  std::vector<fields::Frame> frames_;
};

void FrameSolver::prepare() {
  for (std::int64_t i = 0; i < count_; ++i) {
    double sum = 0;
    for (const FieldLink& link : nodes_.links_of(i)) sum += static_cast<double>(link.weight);
    degree_[i] = std::max(sum, 1e-9);
  }
  for (std::size_t i = 0; i < nodes_.surface.size(); ++i) {
    const SurfaceNode& node = nodes_.surface[i];
    turnings_.emplace_back(node.normal);
    const auto column = static_cast<std::int64_t>(i);
    if (node.kind == Kind::fixed) field_.col(column) = fields::harmonics_of(node.frame);
    if (node.kind == Kind::smooth)
      field_.col(column) =
          fields::common_part * fields::harmonics_of_axis(node.normal) + turnings_[i].part_of(node.suggested);
  }
}

double FrameSolver::suggestion_weight_of(std::size_t i) const {
  if (!nodes_.is_on_surface(i)) return 0;
  const SurfaceNode& node = nodes_.surface[i];
  const double trust = node.kind == Kind::smooth ? suggestion_weight * node.suggested.norm() / fields::cross_norm : 1;
  return degree_[static_cast<std::int64_t>(i)] * trust;
}

// The matrix of the quadratic energy: differences along links, from suggestions, and from what is held.
Field FrameSolver::apply(const Field& x, double hold) const {
  Field y(9, count_);
  parallel_for(count_, 512, [&](std::int64_t i) {
    const auto node = static_cast<std::size_t>(i);
    fields::Harmonics sum = ((1 + hold) * degree_[i] + suggestion_weight_of(node)) * x.col(i);
    for (const FieldLink& link : nodes_.links_of(node)) sum -= static_cast<double>(link.weight) * x.col(link.node);
    y.col(i) = sum;
  });
  return y;
}

// Of the field as it is, which nothing holds back yet.
Field FrameSolver::residual() const {
  Field result = -apply(field_, 0);
  for (std::size_t i = 0; i < nodes_.surface.size(); ++i)
    result.col(static_cast<std::int64_t>(i)) += suggestion_weight_of(i) * nodes_.surface[i].suggested;
  restrict_to_freedom(result);
  return result;
}

// Removes the components that would change a fixed frame, or turn one off its normal.
void FrameSolver::restrict_to_freedom(Field& x) const {
  for (std::size_t i = 0; i < nodes_.surface.size(); ++i) {
    const auto column = static_cast<std::int64_t>(i);
    if (nodes_.surface[i].kind == Kind::fixed) x.col(column).setZero();
    if (nodes_.surface[i].kind == Kind::smooth) x.col(column) = turnings_[i].part_of(x.col(column));
  }
}

// Changes the field to where the energy is least, with the field as it is held. Conjugate gradients, preconditioned by
// the diagonal.
void FrameSolver::diffuse(double hold) {
  constexpr int most_iterations = 100;
  constexpr double tolerance = 1e-2;
  const auto preconditioned = [&](const Field& x) -> Field { return x.array().rowwise() / degree_.array(); };
  Field rest = residual();
  Field z = preconditioned(rest), direction = z;
  double product = rest.cwiseProduct(z).sum();
  const double enough = tolerance * tolerance * product;
  for (int k = 0; k < most_iterations && product > enough; ++k) {
    Field image = apply(direction, hold);
    restrict_to_freedom(image);
    const double step = product / direction.cwiseProduct(image).sum();
    field_ += step * direction;
    rest -= step * image;
    z = preconditioned(rest);
    const double next = rest.cwiseProduct(z).sum();
    direction = z + (next / product) * direction;
    product = next;
  }
}

void FrameSolver::lay_on_normal(std::size_t i) {
  if (nodes_.is_on_surface(i) && nodes_.surface[i].kind == Kind::smooth)
    frames_[i] = fields::turned_onto(frames_[i], nodes_.surface[i].normal);
}

void FrameSolver::project() {
  parallel_for(count_, 64, [&](std::int64_t i) {
    const auto node = static_cast<std::size_t>(i);
    const bool is_fixed = nodes_.is_on_surface(node) && nodes_.surface[node].kind == Kind::fixed;
    frames_[node] = is_fixed ? nodes_.surface[node].frame : fields::nearest_frame(field_.col(i));
    lay_on_normal(node);
    field_.col(i) = fields::harmonics_of(frames_[node]);
  });
}

// Computes all frames from the field before, so that the order of the nodes does not matter.
void FrameSolver::sweep() {
  Field next = field_;
  parallel_for(count_, 64, [&](std::int64_t i) {
    const auto node = static_cast<std::size_t>(i);
    const SurfaceNode* const surface = nodes_.is_on_surface(node) ? &nodes_.surface[node] : nullptr;
    if (surface && surface->kind == Kind::fixed) return;
    fields::Harmonics sum = inertia * degree_[i] * field_.col(i);
    for (const FieldLink& link : nodes_.links_of(node)) sum += static_cast<double>(link.weight) * field_.col(link.node);
    if (surface) sum += suggestion_weight_of(node) * surface->suggested;
    if (surface && surface->kind == Kind::smooth)
      sum += normal_weight * degree_[i] * fields::harmonics_of_axis(surface->normal);
    frames_[node] = fields::climb_to_frame(sum, frames_[node]);
    lay_on_normal(node);
    next.col(i) = fields::harmonics_of(frames_[node]);
  });
  field_.swap(next);
}

}  // namespace

std::vector<fields::Frame> solve_frame_field(const FieldNodes& nodes) {
  return FrameSolver(nodes).solve();
}

}  // namespace hexpipe::tetmesh::volume
