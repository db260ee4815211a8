#include "tools/tetmesh/volume/lattice_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/periodic_numbers.hpp"

namespace hexpipe {
namespace {

// How strongly a surface point that is one of the lattice for certain holds it, against all its links. Shares of the
// volume in hexes differ by 0.3 % from 2 to 20.
constexpr double anchor_weight = 20;
// Mean of cos(2 pi coordinate) over a surface point's neighbours from which it is held, growing up to 1; below, weakly.
constexpr double anchor_threshold = 0.3, weakest_anchor = 0.05;
// 10 sweeps lose 0.5 % of the volume in hexes, 150 gain 0.1.
constexpr int smoothing_sweeps = 60;
constexpr double inertia = 0.3;  // of a number's own value, against its links

using Phases = std::array<Complex, 3>;

// Which axis of the other frame is the nearest, and whether it points the same way.
struct AxisMatch {
  std::array<std::uint8_t, 3> axis;
  std::array<bool, 3> flipped;
  double quality;  // mean cosine
};

AxisMatch match(const Frame& from, const Frame& to) {
  static constexpr std::array<std::array<std::uint8_t, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  std::array<std::array<double, 3>, 3> cosines;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) cosines[i][j] = dot(from[i], to[j]);
  double best = -1;
  AxisMatch result{};
  for (const auto& order : orders) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::abs(cosines[i][order[i]]);
    if (sum <= best) continue;
    best = sum;
    result.axis = order;
  }
  for (std::size_t i = 0; i < 3; ++i) result.flipped[i] = cosines[i][result.axis[i]] < 0;
  result.quality = best / 3;
  return result;
}

// What a node sees of a neighbour: its axis k is axis[k] there, turned round where flipped, and `turn[k]` further on.
struct Transition {
  std::array<Complex, 3> turn;
  std::array<std::uint8_t, 3> axis;
  std::array<bool, 3> flipped;
  std::int32_t node;
  double weight;
};

class LatticeSolver {
 public:
  LatticeSolver(const FieldNodes& nodes, const std::vector<Frame>& frames)
      : nodes_(nodes),
        frames_(frames),
        transitions_(nodes.links.size()),
        degree_(nodes.size()),
        anchors_(nodes.size()),
        phases_(nodes.size()) {}

  LatticeField solve() {
    for_each_node([&](std::size_t i) { make_transitions(i); });
    for (std::size_t i = 0; i < nodes_.surface.size(); ++i) make_anchors(i);
    diffuse();
    for (Phases& phases : phases_)
      for (Complex& phase : phases) phase = unit(phase);
    for (int i = 0; i < smoothing_sweeps; ++i) sweep();
    return result();
  }

 private:
  template <class Body>
  void for_each_node(Body&& body) const {
    parallel_for(static_cast<std::int64_t>(nodes_.size()), 256,
                 [&](std::int64_t i) { body(static_cast<std::size_t>(i)); });
  }
  std::span<const Transition> transitions_of(std::size_t i) const {
    return std::span(transitions_).subspan(nodes_.offsets[i], nodes_.offsets[i + 1] - nodes_.offsets[i]);
  }

  void make_transitions(std::size_t i);
  Transition make_transition(std::size_t i, const FieldLink& link) const;
  void make_anchors(std::size_t i);
  Phases view_of_neighbours(const std::vector<Phases>& phases, std::size_t i) const;
  double diagonal(std::size_t i, std::size_t axis) const { return degree_[i] + anchors_[i][axis]; }
  void diffuse();
  void sweep();
  LatticeField result() const;

  const FieldNodes& nodes_;
  const std::vector<Frame>& frames_;
  std::vector<Transition> transitions_;  // of each link
  std::vector<double> degree_;
  std::vector<std::array<double, 3>> anchors_;  // weight of the number 1: the node is a point of the lattice
  std::vector<Phases> phases_;
};

void LatticeSolver::make_transitions(std::size_t i) {
  for (std::int64_t l = nodes_.offsets[i]; l < nodes_.offsets[i + 1]; ++l) {
    transitions_[l] = make_transition(i, nodes_.links[l]);
    degree_[i] += transitions_[l].weight;
  }
  degree_[i] = std::max(degree_[i], 1e-9);
}

Transition LatticeSolver::make_transition(std::size_t i, const FieldLink& link) const {
  const auto j = static_cast<std::size_t>(link.node);
  const AxisMatch matched = match(frames_[i], frames_[j]);
  Transition t{{}, matched.axis, matched.flipped, link.node, 0};
  t.weight = static_cast<double>(link.weight) * std::max(0.0, 4 * matched.quality - 3);
  const Vec3 back = (2 / (nodes_.sizes[i] + nodes_.sizes[j])) * (nodes_.points[i] - nodes_.points[j]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& there = frames_[j][t.axis[k]];
    const Vec3 mean = 0.5 * (frames_[i][k] + (t.flipped[k] ? -there : there));
    t.turn[k] = std::polar(1.0, 2 * std::numbers::pi * dot(mean, back));
  }
  return t;
}

// A surface point is one of the lattice as far as its neighbours on the surface are, seen from it; along its normal in
// any case.
void LatticeSolver::make_anchors(std::size_t i) {
  constexpr double normal_cosine = 0.9;
  std::array<double, 3> sum{};
  double count = 0;
  for (const Transition& t : transitions_of(i)) {
    if (!nodes_.is_on_surface(static_cast<std::size_t>(t.node))) continue;
    ++count;
    for (std::size_t k = 0; k < 3; ++k) sum[k] += t.turn[k].real();
  }
  const SurfaceNode& node = nodes_.surface[i];
  for (std::size_t k = 0; k < 3; ++k) {
    const double mean = count > 0 ? sum[k] / count : 0;
    double trust = std::max(weakest_anchor, (mean - anchor_threshold) / (1 - anchor_threshold));
    if (node.kind == SurfaceNode::Kind::smooth && std::abs(dot(frames_[i][k], node.normal)) > normal_cosine) trust = 1;
    anchors_[i][k] = anchor_weight * trust * degree_[i];
  }
}

Phases LatticeSolver::view_of_neighbours(const std::vector<Phases>& phases, std::size_t i) const {
  Phases sum{};
  for (const Transition& t : transitions_of(i)) {
    const Phases& theirs = phases[t.node];
    for (std::size_t k = 0; k < 3; ++k) {
      const Complex there = theirs[t.axis[k]];
      sum[k] += t.weight * times(t.flipped[k] ? std::conj(there) : there, t.turn[k]);
    }
  }
  return sum;
}

void LatticeSolver::diffuse() {
  constexpr DiffusionLimits limits{60, 1e-3};
  std::vector<Phases> held(nodes_.size());
  for (std::size_t i = 0; i < held.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) held[i][k] = anchors_[i][k];
  phases_ = diffused<3>(
      std::move(held), limits, [&](const auto& body) { for_each_node(body); },
      [&](std::size_t i, std::size_t k) { return diagonal(i, k); },
      [&](const std::vector<Phases>& phases, std::size_t i) { return view_of_neighbours(phases, i); });
}

// All at once from the numbers before, so that the order of the nodes does not count.
void LatticeSolver::sweep() {
  std::vector<Phases> next(nodes_.size());
  for_each_node([&](std::size_t i) {
    const Phases view = view_of_neighbours(phases_, i);
    for (std::size_t k = 0; k < 3; ++k)
      next[i][k] = unit(view[k] + inertia * degree_[i] * phases_[i][k] + anchors_[i][k]);
  });
  phases_.swap(next);
}

LatticeField LatticeSolver::result() const {
  LatticeField field;
  field.coordinates.resize(nodes_.size());
  field.agreement.resize(nodes_.size());
  for_each_node([&](std::size_t i) {
    const Phases view = view_of_neighbours(phases_, i);
    double least = degree_[i];
    for (std::size_t k = 0; k < 3; ++k) {
      field.coordinates[i][k] = std::arg(phases_[i][k]) / (2 * std::numbers::pi);
      least = std::min(least, std::abs(view[k]));
    }
    field.agreement[i] = least / degree_[i];
  });
  return field;
}

}  // namespace

LatticeField solve_lattice_field(const FieldNodes& nodes, const std::vector<Frame>& frames) {
  return LatticeSolver(nodes, frames).solve();
}

}  // namespace hexpipe
