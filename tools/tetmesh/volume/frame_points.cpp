#include "tools/tetmesh/volume/frame_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "common/run/parallel.hpp"
#include "common/run/progress.hpp"
#include "tools/tetmesh/fields/lattice_proposals.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"
#include "tools/tetmesh/solid/surface_clearance.hpp"
#include "tools/tetmesh/volume/frame_field.hpp"
#include "tools/tetmesh/volume/lattice.hpp"
#include "tools/tetmesh/volume/lattice_field.hpp"
#include "tools/tetmesh/volume/row_guide.hpp"
#include "tools/tetmesh/volume/row_straightening.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

// The least distance of two points in the frame's maximum norm, in steps of the lattice. 0.5 and 0.8 lose 1 % of the
// volume in hexes, 0.7 loses 0.3 %.
constexpr double least_spacing = 0.6;
// A node sees points of the lattice up to one cell away.
constexpr double furthest = 1 + 1e-6;
// Frames further out of a lattice's axes than this are turned.
constexpr double straight_angle = 10;  // degrees
// A point nearer to the surface than this, in sizes, is one on the surface.
constexpr double beside_surface = 0.3;

// A point of the lattice as a node sees it.
struct Proposal {
  Vec3 point;
  double size = 0;  // at the point, as nearly as its node can tell
  std::int32_t node = 0;
  double trust = 0;

  const Vec3& place() const { return point; }
};

// The norm of a vector in units of the frame's axes.
double maximum_norm(const fields::Frame& frame, const Vec3& v) {
  return std::max({std::abs(dot(frame[0], v)), std::abs(dot(frame[1], v)), std::abs(dot(frame[2], v))});
}

}  // namespace

class FrameLattice::Work {
 public:
  Work(const solid::Surface& surface, const TetMesh& background, const TetAdjacency& adjacency,
       const FramePointsOptions& options)
      : surface_(surface),
        options_(options),
        background_(background),
        adjacency_(adjacency),
        nodes_(make_field_nodes(surface, background, adjacency, options.size, options.feature_angle)),
        frames_(solve_frame_field(nodes_)) {}

  void fit(const std::vector<bool>& held);
  const Dislocations& dislocations() {
    find_lines_beside([] {});
    return *lines_;
  }
  surface::RowGuide guide();
  FramePoints points_inside(const solid::Surface& surface);

 private:
  // Calls body(), and looks for the lattice's dislocations at the same time: body() accepts points one after the other.
  template <class Body>
  void find_lines_beside(Body&& body) {
    if (lines_) return body();
    both_at_once([&] { lines_ = find_dislocations(field_->links, field_->coordinates, background_, adjacency_); },
                 body);
  }
  void propose(std::size_t node, std::vector<Proposal>& proposals) const;
  Proposal agreed(const fields::ProposalIndex<Proposal>& index, const Proposal& proposal) const;
  template <class Wanted>
  std::vector<RowPoint> accept(std::span<const Vec3> fixed, Wanted&& is_wanted) const;
  bool is_clear(const solid::SurfaceClearance& clearance, const Proposal& p) const {
    return clearance.is_clear(p.point, options_.clearance * options_.size.at(p.point));
  }
  double turned_share() const;
  bool is_free(const geometry::SizedPointGrid& taken, const Proposal& proposal) const;

  const solid::Surface& surface_;
  const FramePointsOptions options_;
  const TetMesh& background_;
  const TetAdjacency& adjacency_;
  FieldNodes nodes_;
  std::vector<fields::Frame> frames_;
  std::vector<bool> held_;  // by point of the surface
  std::optional<LatticeField> field_;
  std::vector<Vec3> spacing_;        // of the lattice along the frames' axes, in sizes
  std::vector<Proposal> proposals_;  // the most trusted first
  std::optional<Dislocations> lines_;
};

void FrameLattice::Work::fit(const std::vector<bool>& held) {
  held_ = held;
  field_.emplace(solve_lattice_field(nodes_, frames_, held));
  lines_.reset();
  spacing_.clear();
  for (const auto& [x, y, z] : field_->steps) spacing_.push_back({norm(x), norm(y), norm(z)});
  proposals_ = parallel_collect<Proposal>(
      static_cast<std::int64_t>(nodes_.size()), 512,
      [&](std::int64_t i, std::vector<Proposal>& proposals) { propose(static_cast<std::size_t>(i), proposals); });
  fields::agree(
      surface_.points.front(), [](const Proposal& p) { return p.size; },
      [&](const auto& index, const Proposal& p) { return agreed(index, p); }, proposals_);
}

surface::RowGuide FrameLattice::Work::guide() {
  surface::RowGuide guide{coordinates_on_surface(nodes_, frames_, *field_, options_.size), {}};
  std::vector<Vec3> fixed;
  for (std::size_t v = 0; v < held_.size(); ++v)
    if (held_[v]) fixed.push_back(surface_.points[v]);
  const solid::SurfaceClearance clearance(surface_);
  const auto is_beside = [&](const Vec3& p) { return !clearance.is_clear(p, beside_surface * options_.size.at(p)); };
  // Points inside are chosen, too, so that rows end at the same places on the surface and below it.
  const auto is_wanted = [&](const Proposal& p) {
    if (!is_clear(clearance, p)) return is_beside(p.point);
    return (options_.clearance < beside_surface && is_beside(p.point)) || clearance.is_inside(p.point);
  };
  find_lines_beside([&] {
    for (const RowPoint& row : accept(fixed, is_wanted))
      if (is_beside(row.at)) guide.points.push_back(row.at);
  });
  return guide;
}

FramePoints FrameLattice::Work::points_inside(const solid::Surface& surface) {
  const solid::SurfaceClearance clearance(surface);
  const auto is_well_inside = [&](const Proposal& p) { return is_clear(clearance, p) && clearance.is_inside(p.point); };
  FramePoints result{{}, turned_share()};
  find_lines_beside([&] {
    for (const RowPoint& row : accept(surface.points, is_well_inside)) result.points.push_back(row.at);
  });
  for (std::size_t i = 0; i < result.points.size(); ++i)
    result.points[i] += jitter_of(i, options_.jitter * options_.size.at(result.points[i]), options_.seed);
  return result;
}

void FrameLattice::Work::propose(std::size_t i, std::vector<Proposal>& proposals) const {
  const auto& steps = field_->steps[i];
  fields::for_each_point_around(field_->coordinates[i], furthest, [&](const auto& cells, double distance) {
    const Vec3 way = cells[0] * steps[0] + cells[1] * steps[1] + cells[2] * steps[2];
    const double here = nodes_.sizes[i], there = options_.size.at(nodes_.points[i] + here * way);
    proposals.push_back({nodes_.points[i] + 0.5 * (here + there) * way, there, static_cast<std::int32_t>(i),
                         fields::trust_at(distance) * field_->agreement[i]});
  });
}

// The mean of all proposals of the same point. It is trusted as much as all of these together.
Proposal FrameLattice::Work::agreed(const fields::ProposalIndex<Proposal>& index, const Proposal& proposal) const {
  const double least = options_.size.least_near(proposal.size, fields::same_point * proposal.size);
  fields::TrustedSum seen;
  index.for_each_at(proposal.point, proposal.size, least,
                    [&](const Proposal& other) { seen.add(other.trust, other.point); });
  return seen.trust > 0 ? Proposal{seen.sum * (1 / seen.trust), proposal.size, proposal.node, seen.trust} : proposal;
}

// The most trusted proposals that are wanted, none too near to another or to the fixed points; then lines along which
// rows end are made straight.
template <class Wanted>
std::vector<RowPoint> FrameLattice::Work::accept(std::span<const Vec3> fixed, Wanted&& is_wanted) const {
  geometry::SizedPointGrid taken(surface_.points.front());
  for (const Vec3& p : fixed) taken.add(p, 2 * least_spacing * options_.size.at(p));
  std::vector<RowPoint> rows;
  // Proposals that agree exactly follow each other.
  const Vec3* decided = nullptr;  // the last point that was taken or is not wanted
  for (const Proposal& p : proposals_) {
    if ((decided && p.point == *decided) || !is_free(taken, p)) continue;
    decided = &p.point;
    if (!is_wanted(p)) continue;
    taken.add(p.point, 2 * least_spacing * p.size);
    const auto& [x, y, z] = field_->steps[p.node];
    rows.push_back({p.point, {p.size * x, p.size * y, p.size * z}});
  }
  return straighten_row_ends(fixed, std::move(rows));
}

bool FrameLattice::Work::is_free(const geometry::SizedPointGrid& taken, const Proposal& proposal) const {
  fields::Frame units = frames_[proposal.node];  // in these units, the frame's coordinates count least spacings
  Vec3 reach;                                    // of a box of one unit, along the coordinate axes
  for (std::size_t k = 0; k < 3; ++k) {
    const double spacing = least_spacing * spacing_[proposal.node][k] * proposal.size;
    const Vec3& axis = units[k];
    reach += spacing * Vec3{std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)};
    units[k] = (1 / spacing) * axis;
  }
  const double least = 2 * least_spacing * options_.size.least_near(proposal.size, norm(reach));
  return taken.all_near(proposal.point, reach, least,
                        [&](std::int32_t i) { return maximum_norm(units, taken.points()[i] - proposal.point) >= 1; });
}

double FrameLattice::Work::turned_share() const {
  const double least_cosine = std::cos(straight_angle * std::numbers::pi / 180);
  const auto is_straight = [&](const fields::Frame& frame) {
    return std::ranges::all_of(options_.axes,
                               [&](const Vec3& axis) { return maximum_norm(frame, axis) >= least_cosine; });
  };
  const auto straight = std::ranges::count_if(frames_, is_straight);
  return 1 - static_cast<double>(straight) / static_cast<double>(frames_.size());
}

FrameLattice::FrameLattice(const solid::Surface& surface, const TetMesh& background, const TetAdjacency& adjacency,
                           const FramePointsOptions& options)
    : work_(new Work(surface, background, adjacency, options)) {}

FrameLattice::~FrameLattice() = default;

void FrameLattice::fit(const std::vector<bool>& held) {
  work_->fit(held);
}

const Dislocations& FrameLattice::dislocations() const {
  return work_->dislocations();
}

surface::RowGuide FrameLattice::guide() const {
  return work_->guide();
}

FramePoints FrameLattice::points_inside(const solid::Surface& surface) const {
  return work_->points_inside(surface);
}

}  // namespace hexpipe::tetmesh::volume
