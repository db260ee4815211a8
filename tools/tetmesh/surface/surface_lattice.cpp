// Periodic coordinates, as on the nodes of a volume (volume/lattice_field.hpp). Each triangle has two complex numbers,
// exp(2 pi i coordinate of its centre), one for each of its two directions. From one triangle to the next a number
// turns by the distance between them (Ray, Li, Lévy, Sheffer, Alliez: Periodic global parameterization, 2006). Feature
// edges and the points on them hold the numbers of the triangles beside them. Two sides that face each other hold each
// other's numbers (links_across.hpp), because rows end inside the model where these differ. Then every triangle
// proposes the points of the lattice that it sees, and the triangles that see the same point agree on its place.

#include "tools/tetmesh/surface/surface_lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/fields/lattice_proposals.hpp"
#include "tools/tetmesh/fields/lattice_steps.hpp"
#include "tools/tetmesh/fields/whole_rows.hpp"
#include "tools/tetmesh/surface/links_across.hpp"
#include "tools/tetmesh/surface/row_ends.hpp"
#include "tools/tetmesh/surface/row_joining.hpp"
#include "tools/tetmesh/surface/surface_curl.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// How strongly a feature edge, and a point on it, pull the numbers of a triangle, relative to all links of the
// triangle. A point_weight from 2 to 20 changes the share of the volume in hexes by up to 0.4 % on larger models.
constexpr double edge_weight = 20, point_weight = 5;
// How strongly the guide pulls where it is certain; at 20 and 100 there are as many hexes.
constexpr double guide_weight = 5;
// Where features ask a triangle for coordinates that agree by more, from 0 to 1, they hold it.
constexpr double least_accord = 0.9;
// Where the nodes that the guide asks agree by less, from 0 to 1, its coordinates do not change distances.
constexpr double least_agreement_of_guide = 0.5;
constexpr fields::DiffusionLimits diffusion_limits{200, 1e-3};
constexpr int smoothing_sweeps = 20;
// Both sides of a wall agree again after these.
constexpr int sweeps_after_joining = 10;
constexpr double certain = 1e-3;  // least modulus of a number that some feature has reached
// The least strength with which the step to the next point of the lattice keeps to the field.
constexpr double least_hold = 1e-9;
// A triangle proposes the points within this distance along each direction, in steps of the lattice.
constexpr double furthest = 0.75;
// On a surface with more triangles, only this many for each square of the size make proposals.
constexpr double most_speakers = 32;
// Two proposals are the same point only if the cosine between the normals of their triangles is at least this.
constexpr double least_normal_cosine = 0.3;

using Phases = std::array<fields::Complex, 2>;
// The step from one point of the lattice to the next along each direction: its two components, in sizes.
using Steps = std::array<std::array<double, 2>, 2>;
constexpr Steps straight{{{1, 0}, {0, 1}}};

struct Proposal {
  SurfacePoint point;
  double trust = 0;

  const Vec3& place() const { return point.position; }
};

// Calls body(link) for the links of a triangle, to those beside it and to those that face it.
template <class Body>
void for_each_link(const SurfaceLinks& links, const LinksAcross& across, std::int32_t f, Body&& body) {
  for (const SurfaceLink& link : links.at(f))
    if (link.neighbour != no_index) body(link);
  for (const SurfaceLink& link : across.of(f)) body(link);
}

// Spreads the numbers of triangles along the links, as they are now. A surface that was refined has neighbours far
// apart in its list of triangles, so the triangles stand here in the order in which a walk over the links finds them:
// then what a triangle sees is in the cache. Scalar products are summed up in the order of the list all the same.
class PhaseSolver {
 public:
  PhaseSolver(const SurfaceLinks& links, const LinksAcross& across, const std::vector<double>& degrees,
              const std::vector<Phases>& targets)
      : order_(walk(links)), terms_(order_.size()) {
    std::vector<std::int32_t> place(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) place[order_[i]] = static_cast<std::int32_t>(i);
    for (const std::int32_t f : order_) {
      std::int64_t count = 0;
      for_each_link(links, across, f, [&](const SurfaceLink&) { ++count; });
      first_view_.push_back(first_view_.back() + count);
    }
    views_.resize(static_cast<std::size_t>(first_view_.back()));
    degrees_ = in_order(degrees);
    targets_ = in_order(targets);
    for_each([&](std::size_t i) {
      std::int64_t next = first_view_[i];
      for_each_link(links, across, order_[i], [&](SurfaceLink link) {
        link.neighbour = place[link.neighbour];
        views_[next++] = fields::LinkView<2>(link);
      });
    });
  }

  std::vector<Phases> diffused(const std::vector<std::array<double, 2>>& pulls) {
    const std::vector<std::array<double, 2>> pull = in_order(pulls);
    return in_list(fields::diffused<2>(
        targets_, diffusion_limits, [&](const auto& body) { for_each(body); },
        [&](std::size_t i, std::size_t k) { return degrees_[i] + pull[i][k]; },
        [&](const std::vector<Phases>& phases, std::size_t i) { return view(phases, i); },
        [&](const std::vector<Phases>& a, const std::vector<Phases>& b) { return product(a, b); }));
  }

  void smooth(std::vector<Phases>& phases, int sweeps) const {
    std::vector<Phases> numbers = in_order(phases);
    fields::smooth<2>(
        numbers, sweeps, [&](const auto& body) { for_each(body); },
        [&](const std::vector<Phases>& before, std::size_t i) { return view(before, i); },
        [&](std::size_t i) { return degrees_[i]; }, [&](std::size_t i, std::size_t k) { return targets_[i][k]; });
    phases = in_list(numbers);
  }

 private:
  static std::vector<std::int32_t> walk(const SurfaceLinks& links);
  template <class Body>
  void for_each(Body&& body) const {
    parallel_for(static_cast<std::int64_t>(order_.size()), 512,
                 [&](std::int64_t i) { body(static_cast<std::size_t>(i)); });
  }
  template <class T>
  std::vector<T> in_order(const std::vector<T>& list) const {
    std::vector<T> result(list.size());
    for_each([&](std::size_t i) { result[i] = list[order_[i]]; });
    return result;
  }
  template <class T>
  std::vector<T> in_list(const std::vector<T>& numbers) const {
    std::vector<T> result(numbers.size());
    for_each([&](std::size_t i) { result[order_[i]] = numbers[i]; });
    return result;
  }
  Phases view(const std::vector<Phases>& phases, std::size_t i) const {
    fields::SeenSum<2> sum;
    for (std::int64_t l = first_view_[i]; l < first_view_[i + 1]; ++l)
      views_[l].add_seen(phases[views_[l].neighbour()], sum);
    return sum.numbers();
  }
  double product(const std::vector<Phases>& a, const std::vector<Phases>& b) {
    for_each([&](std::size_t i) {
      for (std::size_t k = 0; k < 2; ++k) terms_[order_[i]][k] = fields::scalar_product(a[i][k], b[i][k]);
    });
    double sum = 0;
    for (const auto& [x, y] : terms_) {
      sum += x;
      sum += y;
    }
    return sum;
  }

  std::vector<std::int32_t> order_;          // the triangles
  std::vector<std::int64_t> first_view_{0};  // by place in the order, and behind the last one
  std::vector<fields::LinkView<2>> views_;   // of the links of each, with places as neighbours
  std::vector<double> degrees_;
  std::vector<Phases> targets_;
  std::vector<std::array<double, 2>> terms_;  // of a product, by triangle
};

std::vector<std::int32_t> PhaseSolver::walk(const SurfaceLinks& links) {
  const std::size_t count = links.surface.triangles.size();
  std::vector<std::int32_t> order;
  order.reserve(count);
  std::vector<bool> found(count);
  const auto find = [&](std::int32_t f) {
    if (found[f]) return;
    found[f] = true;
    order.push_back(f);
  };
  std::size_t next = 0;
  for (std::int32_t seed = 0; seed < static_cast<std::int32_t>(count); ++seed) {
    find(seed);
    for (; next < order.size(); ++next)
      for (const SurfaceLink& link : links.at(order[next]))
        if (link.neighbour != no_index) find(link.neighbour);
  }
  return order;
}

class LatticeMaker {
 public:
  explicit LatticeMaker(const CorrectedLinks& known)
      : surface_(known.links.surface),
        field_(known.links.field),
        walker_(surface_, field_),
        links_(known.links),
        across_(known.across) {
    const std::size_t count = surface_.triangles.size();
    degrees_.resize(count);
    pulls_.resize(count);
    targets_.resize(count);
    phases_.resize(count);
    greatest_size_ = std::ranges::max(surface_.sizes);
  }

  SurfaceLattice make(std::span<const Vertex> kept, const RowOptions& rows, const RowGuide& guide) {
    weigh_links();
    make_anchors(kept);
    if (guide.coordinates) {
      const std::vector<Phases> known = follow(guide);
      measure_distances(known, least_agreement_of_guide);
    } else if (rows.are_whole) {
      round_rows();
    }
    PhaseSolver solver(links_, across_, degrees_, targets_);
    phases_ = solver.diffused(pulls_);
    reach_the_rest();
    solver.smooth(phases_, smoothing_sweeps);
    if (rows.stretch > 0) {
      join_rows(links_, across_, targets_, rows.stretch, phases_);
      PhaseSolver(links_, across_, degrees_, targets_).smooth(phases_, sweeps_after_joining);
    }
    if (guide.coordinates) measure_distances(phases_, 0);
    propose();
    fields::agree(
        surface_.centres.front(), [&](const Proposal&) { return greatest_size_; },
        [&](const auto& index, const Proposal& p) { return agreed(index, p); }, proposals_);
    SurfaceLattice lattice;
    lattice.row_ends = count_row_ends(links_, phases_);
    lattice.points.reserve(proposals_.size());
    for (const Proposal& p : proposals_) lattice.points.push_back(p.point);
    // Links measure distances over the unrounded edges of fillets (crest_lines.hpp), which are longer than the fillets.
    // Steps hardly show that, because links across a narrow strip weigh little beside those along it.
    for (std::int32_t f = 0; f < static_cast<std::int32_t>(steps_.size()); ++f) {
      const auto axes = directions(f);
      std::array<double, 2> spacing;
      for (std::size_t k = 0; k < 2; ++k)
        spacing[k] = std::hypot(steps_[f][k][0], steps_[f][k][1]) / links_.stretch.in_direction(f, axes[k]);
      lattice.spacing.push_back(spacing);
    }
    return lattice;
  }

 private:
  std::array<Vec3, 2> directions(std::int32_t f) const { return field_.axes(surface_, f); }
  template <class Body>
  void for_each_triangle(Body&& body) const {
    parallel_for(static_cast<std::int64_t>(phases_.size()), 512,
                 [&](std::int64_t f) { body(static_cast<std::int32_t>(f)); });
  }
  void weigh_links();
  void make_anchors(std::span<const Vertex> kept);
  void pull(std::int32_t f, std::size_t axis, double weight, double coordinate);
  void round_rows();
  std::vector<Phases> follow(const RowGuide& guide);
  void measure_distances(const std::vector<Phases>& phases, double least_agreement);
  Phases view_of_neighbours(std::int32_t f) const;
  void reach_the_rest();
  Steps steps_of(std::int32_t f) const;
  std::vector<AreaSample> speakers() const;
  void propose();
  void propose(const AreaSample& speaker, std::vector<Proposal>& proposals) const;
  Proposal agreed(const fields::ProposalIndex<Proposal>& index, const Proposal& proposal) const;

  const FieldSurface& surface_;
  const CrossField& field_;
  FieldWalker walker_;
  double greatest_size_;
  SurfaceLinks links_;
  LinksAcross across_;
  std::vector<double> degrees_;               // of each triangle: the sum of the weights of its links
  std::vector<std::array<double, 2>> pulls_;  // of features on each number of a triangle: their sum
  std::vector<Phases> targets_;               // the numbers that features ask for, each times its pull
  std::vector<Phases> phases_;
  std::vector<Steps> steps_;
  std::vector<Proposal> proposals_;
};

void LatticeMaker::weigh_links() {
  links_.for_each_pair([&](geometry::HalfEdge h) {
    degrees_[geometry::triangle_of(h)] += links_.of[h].weight;
    degrees_[geometry::triangle_of(surface_.twins[h])] += links_.of[h].weight;
  });
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(degrees_.size()); ++f) {
    for (const SurfaceLink& link : across_.of(f)) degrees_[f] += link.weight;
    degrees_[f] = std::max(degrees_[f], 1e-9);
  }
}

void LatticeMaker::pull(std::int32_t f, std::size_t axis, double weight, double coordinate) {
  const double strength = weight * degrees_[f];
  pulls_[f][axis] += strength;
  targets_[f][axis] += strength * fields::number_at(coordinate);
}

void LatticeMaker::make_anchors(std::span<const Vertex> kept) {
  std::vector<bool> is_kept(surface_.points.size());
  for (const Vertex v : kept) is_kept[v] = true;
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(links_.of.size()); ++h) {
    const std::int32_t f = geometry::triangle_of(h);
    const Vertex v = geometry::start_of(surface_.triangles, h);
    const Vec3 from_start = surface_.centres[f] - surface_.points[v];
    const auto axes = directions(f);
    for (std::size_t k = 0; k < 2; ++k) {
      const double coordinate = dot(axes[k], from_start) / surface_.sizes[f];
      if (surface_.feature[h] && std::abs(dot(axes[k], surface_.inward(h))) > aligned_cosine)
        pull(f, k, edge_weight, coordinate);
      else if (is_kept[v])
        pull(f, k, point_weight, coordinate);
    }
  }
}

// Changes distances so that whole numbers of rows lie between features.
void LatticeMaker::round_rows() {
  const std::size_t count = phases_.size();
  std::vector<std::int64_t> offsets{0};
  std::vector<fields::PeriodicLink<2>> links;
  fields::HeldCoordinates<2> held(count);
  for (std::size_t f = 0; f < count; ++f) {
    for_each_link(links_, across_, static_cast<std::int32_t>(f),
                  [&](const SurfaceLink& link) { links.push_back(link); });
    offsets.push_back(static_cast<std::int64_t>(links.size()));
    for (std::size_t k = 0; k < 2; ++k)
      if (std::abs(targets_[f][k]) > least_accord * pulls_[f][k]) held[f][k] = fields::coordinate_of(targets_[f][k]);
  }
  const auto shifts = fields::whole_row_shifts<2>({offsets, links}, held);
  if (shifts.empty()) return;
  links_.change_distances([&](geometry::HalfEdge h, SurfaceLink& link) {
    link.move(shifts[geometry::triangle_of(h)], shifts[link.neighbour]);
  });
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(count); ++f)
    for (SurfaceLink& link : across_.of(f)) link.move(shifts[f], shifts[link.neighbour]);
}

// Pulls every triangle to the guide's coordinates, which it returns.
std::vector<Phases> LatticeMaker::follow(const RowGuide& guide) {
  std::vector<Phases> known(phases_.size());
  for_each_triangle([&](std::int32_t f) {
    known[f] = guide.coordinates(surface_.centres[f], surface_.normals[f], directions(f));
    for (std::size_t k = 0; k < 2; ++k) {
      pulls_[f][k] += guide_weight * degrees_[f] * std::abs(known[f][k]);
      targets_[f][k] += guide_weight * degrees_[f] * known[f][k];
    }
  });
  return known;
}

// Distances are what lies between the coordinates, so that steps are those of the guide's rows. Where the modulus of a
// number is less than the least agreement, nothing is known.
void LatticeMaker::measure_distances(const std::vector<Phases>& phases, double least_agreement) {
  const RowCoordinates coordinates = row_coordinates(phases);
  const RowJumps jumps = row_jumps(links_, coordinates);
  links_.change_distances([&](geometry::HalfEdge h, SurfaceLink& link) {
    const std::int32_t f = geometry::triangle_of(h);
    for (std::size_t k = 0; k < 2; ++k) {
      if (std::min(std::abs(phases[f][k]), std::abs(phases[link.neighbour][link.axis[k]])) < least_agreement) continue;
      link.distance[k] = coordinates[f][k] + jumps[h][k] - link.seen_along(coordinates[link.neighbour], k);
    }
  });
}

Phases LatticeMaker::view_of_neighbours(std::int32_t f) const {
  fields::SeenSum<2> sum;
  for_each_link(links_, across_, f,
                [&](const SurfaceLink& link) { fields::LinkView<2>(link).add_seen(phases_[link.neighbour], sum); });
  return sum.numbers();
}

// Triangles too far from any feature take over the numbers of a neighbour, turned by the distance to it.
void LatticeMaker::reach_the_rest() {
  const auto count = static_cast<std::int32_t>(phases_.size());
  std::vector<std::int32_t> queue;
  std::vector<bool> reached(phases_.size());
  const auto reach = [&](std::int32_t f, const Phases& phases) {
    for (std::size_t k = 0; k < 2; ++k) phases_[f][k] = fields::unit(phases[k]);
    reached[f] = true;
    queue.push_back(f);
  };
  for (std::int32_t f = 0; f < count; ++f)
    if (std::min(std::norm(phases_[f][0]), std::norm(phases_[f][1])) > certain * certain) reach(f, phases_[f]);
  std::size_t next = 0;
  for (std::int32_t seed = 0; seed < count; ++seed) {
    for (; next < queue.size(); ++next)
      for (geometry::HalfEdge h = 3 * queue[next]; h < 3 * queue[next] + 3; ++h) {
        if (links_.of[h].neighbour == no_index || reached[links_.of[h].neighbour]) continue;
        reach(links_.of[h].neighbour, fields::LinkView<2>(links_.of[surface_.twins[h]]).seen(phases_[queue[next]]));
      }
    if (!reached[seed]) reach(seed, {fields::Complex(1), fields::Complex(1)});
  }
}

// By the distances to the neighbours, as they have been changed.
Steps LatticeMaker::steps_of(std::int32_t f) const {
  fields::StepFit<2> fit;
  for (geometry::HalfEdge h = 3 * f; h < 3 * f + 3; ++h) {
    const SurfaceLink& link = links_.of[h];
    fit.add(link.weight, {link.way[0], link.way[1]}, link.distance);
  }
  fit.hold(fields::rigidity * fit.moment() + least_hold, Eigen::Matrix2d::Identity());
  const auto steps = fit.steps(false);
  if (!steps) return straight;
  return {{{(*steps)(0, 0), (*steps)(1, 0)}, {(*steps)(0, 1), (*steps)(1, 1)}}};
}

// Every triangle, unless there are many more triangles than points: agreed() compares each proposal with all near it.
std::vector<AreaSample> LatticeMaker::speakers() const {
  const auto count = static_cast<std::int32_t>(surface_.triangles.size());
  double squares = 0;
  for (std::int32_t f = 0; f < count; ++f) squares += surface_.squares_of_size(f);
  return surface_.samples(count > most_speakers * squares ? 1 / most_speakers : 0);
}

void LatticeMaker::propose() {
  steps_.resize(phases_.size());
  for_each_triangle([&](std::int32_t f) { steps_[f] = steps_of(f); });
  const std::vector<AreaSample> speaking = speakers();
  proposals_ = parallel_collect<Proposal>(
      static_cast<std::int64_t>(speaking.size()), 512,
      [&](std::int64_t i, std::vector<Proposal>& proposals) { propose(speaking[i], proposals); });
}

void LatticeMaker::propose(const AreaSample& speaker, std::vector<Proposal>& proposals) const {
  const std::int32_t f = speaker.triangle;
  const Phases view = view_of_neighbours(f);
  const double agreement = std::min(std::abs(view[0]), std::abs(view[1])) / degrees_[f];
  const auto axes = directions(f);
  std::array<double, 2> coordinates;
  for (std::size_t k = 0; k < 2; ++k) coordinates[k] = fields::coordinate_of(phases_[f][k]);
  const auto& [first, second] = steps_[f];
  fields::for_each_point_around(coordinates, furthest, [&](const std::array<double, 2>& cells, double distance) {
    const auto& [x, y] = cells;
    const double along = x * first[0] + y * second[0], across = x * first[1] + y * second[1];
    const double length = std::hypot(along, across);
    const Vec3 way = length > 0 ? (along * axes[0] + across * axes[1]) * (1 / length) : axes[0];
    const WalkEnd end = walker_.walk_straight({surface_.centres[f], f}, way, length * surface_.sizes[f]);
    if (!end.at_feature) proposals.push_back({end.point, fields::trust_at(distance) * agreement * speaker.area});
  });
}

// The mean of all proposals of the same point, with the sum of their trust.
Proposal LatticeMaker::agreed(const fields::ProposalIndex<Proposal>& index, const Proposal& proposal) const {
  const Vec3 &place = proposal.place(), &normal = surface_.normals[proposal.point.triangle];
  const double size = surface_.sizes[proposal.point.triangle];
  fields::TrustedSum seen;
  index.for_each_at(place, size, 0, [&](const Proposal& other) {
    if (dot(surface_.normals[other.point.triangle], normal) >= least_normal_cosine)
      seen.add(other.trust, other.place() - place);
  });
  const auto& [sum, trust] = seen;
  if (trust <= 0) return proposal;
  const Vec3 way = sum * (1 / trust) - dot(sum, normal) / trust * normal;
  const double length = norm(way);
  if (length <= 0) return {proposal.point, trust / (size * size)};
  return {walker_.walk_straight(proposal.point, unit(way), length).point, trust / (size * size)};
}

}  // namespace

CorrectedLinks::CorrectedLinks(const FieldSurface& surface, const CrossField& field,
                               std::span<const OppositeSide> opposite, std::span<const Vertex> kept)
    : links(surface, field), across(links, opposite) {
  correct_curl(links, kept);
}

SurfaceLattice surface_lattice(const CorrectedLinks& known, std::span<const Vertex> kept, const RowOptions& rows,
                               const RowGuide& guide) {
  return LatticeMaker(known).make(kept, rows, guide);
}

}  // namespace hexpipe::tetmesh::surface
