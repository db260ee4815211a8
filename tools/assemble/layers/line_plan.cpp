#include "tools/assemble/layers/line_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/item_lists.hpp"
#include "common/mesh/vertex_items.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::layers {
namespace {

// A line whose normals all lie this near to it stands on a smooth wall.
constexpr double smooth_sight = 0.9;
// The most of the way to the next boundary that a line takes: where layers come from there, too, and elsewhere.
constexpr double share_between_walls = 0.35, share_before_others = 0.6;
// Heights rise by this along the wall.
constexpr double steepest = 0.4;
// Edges of the inner mesh keep this share of the length that they have on the wall.
constexpr double least_edge = 0.35;
constexpr int rounds_of_edges = 10;
// How much of the mean way along the wall of its neighbours a line takes over. Lines beside an edge then lean towards
// the one that stands on it, each half as much as the one before, and cells at the edge do not bear all of it.
constexpr double leaning = 0.8;
constexpr int rounds_of_leaning = 20;
// Lines lean only where the layers are this high beside the edges of the wall.
constexpr double leans_above = 0.3;

VertexItemsOf<LineIndex> neighbours_of(const Walls& walls) {
  return VertexItemsOf<LineIndex>(walls.lines().size(), [&](auto&& visit) {
    for (const LineEdge& edge : walls.edges()) visit(edge.lines[0], edge.lines[1]), visit(edge.lines[1], edge.lines[0]);
  });
}

double least_sine(std::span<const Vec3> normals, const Vec3& direction) {
  double least = 1;
  for (const Vec3& normal : normals) least = std::min(least, dot(normal, direction));
  return least;
}

// The tagged facets as triangles, to see how far it is to the next one.
class Room {
 public:
  Room(const MixedMesh& mesh, const Walls& walls) : mesh_(mesh) {
    std::vector<std::int32_t> wall_tags;
    for (const WallSide& side : walls.sides())
      if (!side.is_run_out) wall_tags.push_back(side.tag);
    sort_unique(wall_tags);
    const auto add = [&](const Triangle& triangle, std::int32_t tag) {
      triangles_.push_back(triangle);
      tags_.push_back(tag);
      is_wall_.push_back(std::ranges::binary_search(wall_tags, tag));
      boxes_.push_back(
          Box::around(std::array{mesh.points[triangle[0]], mesh.points[triangle[1]], mesh.points[triangle[2]]}));
    };
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) add(mesh.triangles.cells[i], mesh.triangles.tags[i]);
    for (std::size_t i = 0; i < mesh.quads.size(); ++i) {
      const Quad& q = mesh.quads.cells[i];
      add({q[0], q[1], q[2]}, mesh.quads.tags[i]);
      add({q[0], q[2], q[3]}, mesh.quads.tags[i]);
    }
    const std::vector<double> zeros(boxes_.size(), 0.0);
    tree_.emplace(boxes_, zeros);
  }

  // How long a line from the vertex in the direction may become.
  double length(Vertex from, const Vec3& direction, std::span<const std::int32_t> along) const {
    return tree_->first_hit(mesh_.points[from], direction, std::numeric_limits<double>::infinity(),
                            [&](std::int32_t i) { return length_to(i, from, direction, along); });
  }

 private:
  double length_to(std::int32_t i, Vertex from, const Vec3& direction, std::span<const std::int32_t> along) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto& [a, b, c] = triangles_[i];
    if (a == from || b == from || c == from) return infinity;
    const Vec3 &o = mesh_.points[a], ab = mesh_.points[b] - o, ac = mesh_.points[c] - o;
    const Vec3 normal = cross(ab, ac);
    const double area = norm(normal), speed = dot(normal, direction);
    // A facet along which the line goes is not before it.
    if (std::abs(speed) < 0.2 * area && std::ranges::find(along, tags_[i]) != along.end()) return infinity;
    if (speed == 0) return infinity;
    const Vec3& start = mesh_.points[from];
    const double length = dot(normal, o - start) / speed;
    if (!(length > 0)) return infinity;
    const Vec3 hit = start + direction * length - o;
    // Barycentric coordinates, by areas; a little beside the triangle counts, too.
    const double square = norm_squared(normal), slack = -1e-6 * square;
    const double v = dot(cross(hit, ac), normal), w = dot(cross(ab, hit), normal);
    if (v < slack || w < slack || v + w > square - slack) return infinity;
    return length * (is_wall_[i] ? share_between_walls : share_before_others);
  }

  const MixedMesh& mesh_;
  std::vector<Triangle> triangles_;
  std::vector<std::int32_t> tags_;
  std::vector<bool> is_wall_;
  std::vector<Box> boxes_;
  std::optional<BoxTree> tree_;
};

class Planner {
 public:
  Planner(const MixedMesh& mesh, const Walls& walls, std::span<const double> asked, std::span<const std::uint8_t> bare)
      : mesh_(mesh),
        walls_(walls),
        asked_(asked),
        bare_(bare),
        neighbours_(neighbours_of(walls)),
        heights_(asked.begin(), asked.end()) {}

  LinePlan run() {
    look();
    limit_by_room();
    grade();
    set_reach();
    lean();
    keep_edges();
    LinePlan plan{std::move(grows_), std::move(reach_), {}, std::move(freedoms_)};
    plan.room.resize(asked_.size());
    for (std::size_t i = 0; i < asked_.size(); ++i)
      plan.room[i] = plan.grows[i] != 0 && asked_[i] > 0 ? heights_[i] / asked_[i] : 0;
    return plan;
  }

 private:
  Vec3 foot(LineIndex line) const { return mesh_.points[walls_.lines()[line].foot]; }
  std::size_t count() const { return asked_.size(); }
  void look();
  void limit_by_room();
  void grade();
  void set_reach();
  void lean();
  void keep_edges();

  const MixedMesh& mesh_;
  const Walls& walls_;
  std::span<const double> asked_;
  std::span<const std::uint8_t> bare_;
  VertexItemsOf<LineIndex> neighbours_;  // by line
  std::vector<double> heights_;
  std::vector<std::uint8_t> grows_;
  std::vector<GuideFreedom> freedoms_;
  std::vector<Sight> sights_;
  std::vector<Vec3> reach_;
};

void Planner::look() {
  std::vector<double> worth;
  for (const Line& line : walls_.lines()) {
    freedoms_.push_back(freedom_of(line.guides));
    sights_.push_back(sight_of(line.normals, freedoms_.back()));
    worth.push_back(sights_.back().sine);
  }
  grows_ = lines_that_see(walls_, bare_);
  close_over_quads(walls_, worth, grows_);
}

void Planner::limit_by_room() {
  const Room room(mesh_, walls_);
  for (std::size_t i = 0; i < count(); ++i) {
    if (grows_[i] == 0) continue;
    const Sight& sight = sights_[i];
    const double length = room.length(walls_.lines()[i].foot, sight.direction, freedoms_[i].tags);
    heights_[i] = std::min({heights_[i], length * sight.sine, heights_[i] * sight.sine / full_sight});
  }
}

// Lowers heights until none rises steeply from its neighbours.
void Planner::grade() {
  std::vector<LineIndex> queue;
  for (std::size_t i = 0; i < count(); ++i)
    if (grows_[i] != 0) queue.push_back(LineIndex(i));
  std::ranges::sort(queue,
                    [&](LineIndex a, LineIndex b) { return std::tie(heights_[a], a) < std::tie(heights_[b], b); });
  // Sweeps from the lowest up; what falls is looked at again.
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const LineIndex line = queue[next];
    for (const LineIndex other : neighbours_.at(line)) {
      if (grows_[other] == 0) continue;
      const double most = heights_[line] + steepest * norm(foot(other) - foot(line));
      if (heights_[other] <= most * (1 + 1e-12)) continue;
      heights_[other] = most;
      queue.push_back(other);
    }
  }
}

void Planner::set_reach() {
  reach_.assign(count(), Vec3{});
  for (std::size_t i = 0; i < count(); ++i)
    if (grows_[i] != 0) reach_[i] = sights_[i].direction * (heights_[i] / sights_[i].sine);
}

// Moves tips along the wall, or along the edge of it on which their line stands.
void Planner::lean() {
  for (int round = 0; round < rounds_of_leaning; ++round)
    for (std::size_t i = 0; i < count(); ++i) {
      const GuideFreedom& freedom = freedoms_[i];
      const bool is_smooth = sights_[i].sine > smooth_sight;
      if (grows_[i] == 0 || !is_smooth || freedom.kind == GuideFreedom::Kind::curve) continue;
      Vec3 mean{};
      double edge = 0, lines = 0;
      for (const LineIndex other : neighbours_.at(LineIndex(i))) {
        mean += reach_[other];
        edge += norm(foot(other) - foot(LineIndex(i)));
        ++lines;
      }
      const Vec3& up = sights_[i].direction;
      Vec3 along = mean * (1 / lines);
      along -= up * dot(up, along);
      if (freedom.kind == GuideFreedom::Kind::face) along -= freedom.axis * dot(freedom.axis, along);
      const double share = leaning * std::min(1.0, heights_[i] * lines / (leans_above * edge));
      reach_[i] = up * (heights_[i] / sights_[i].sine) + along * share;
    }
}

// Lowers lines that come together until the edges between their tips are long enough.
void Planner::keep_edges() {
  for (int round = 0; round < rounds_of_edges; ++round) {
    bool all_long = true;
    for (const LineEdge& edge : walls_.edges()) {
      const auto [a, b] = edge.lines;
      const Vec3 along = foot(b) - foot(a);
      const double lost = dot(reach_[a] - reach_[b], along) / norm_squared(along);
      if (!(lost > 1 - least_edge)) continue;
      all_long = false;
      for (const LineIndex line : {a, b}) {
        const double share = (1 - least_edge) / lost;
        reach_[line] *= share;
        heights_[line] *= share;
      }
    }
    if (all_long) break;
    const std::vector<double> before = heights_;
    grade();
    for (std::size_t i = 0; i < count(); ++i)
      if (before[i] > 0) reach_[i] *= heights_[i] / before[i];
  }
}

}  // namespace

Sight sight_of(std::span<const Vec3> normals, const GuideFreedom& freedom) {
  if (normals.empty() || freedom.kind == GuideFreedom::Kind::none) return {};
  Vec3 direction;
  if (freedom.kind == GuideFreedom::Kind::curve) {
    direction = freedom.axis;
    if (least_sine(normals, -direction) > least_sine(normals, direction)) direction = -direction;
  } else {
    std::vector<Vec3> within(normals.begin(), normals.end());
    if (freedom.kind == GuideFreedom::Kind::face)
      for (Vec3& normal : within) normal -= freedom.axis * dot(freedom.axis, normal);
    direction = unit(shape::shortest_in_hull(within));
  }
  // Where the part turns away behind the edge of a wall, the face beside it does not go on into the part.
  for (const Vec3& inwards : freedom.inwards)
    if (!(dot(inwards, direction) > 0)) return {};
  return {direction, least_sine(normals, direction)};
}

void close_over_quads(const Walls& walls, std::span<const double> worth, std::vector<std::uint8_t>& grows) {
  for (bool changed = true; changed;) {
    changed = false;
    const auto drop = [&](LineIndex line) {
      if (grows[line] == 0) return;
      grows[line] = 0;
      changed = true;
    };
    for (const WallSide& side : walls.sides()) {
      if (side.size() == 3) continue;
      const auto& l = side.lines;
      int count = 0;
      for (const LineIndex line : l) count += grows[line];
      if (count == 4 || count == 0) continue;
      if (count == 3) {
        const int gone =
            static_cast<int>(std::ranges::find_if(l, [&](LineIndex line) { return grows[line] == 0; }) - l.begin());
        const LineIndex next = l[(gone + 1) % 4], last = l[(gone + 3) % 4];
        drop(worth[next] < worth[last] ? next : last);
      } else if (count == 1 || (grows[l[0]] == grows[l[2]])) {
        for (const LineIndex line : l) drop(line);
      }
    }
  }
}

std::vector<std::uint8_t> lines_that_see(const Walls& walls, std::span<const std::uint8_t> bare) {
  std::vector<std::uint8_t> result;
  for (const Line& line : walls.lines())
    result.push_back(bare[line.foot] == 0 && line.is_on_wall &&
                     sight_of(line.normals, freedom_of(line.guides)).sine >= least_sight);
  // Where walls touch along an edge, columns on both sides would share their sides.
  for (const LineEdge& edge : walls.edges())
    if (edge.sides > 2 || (edge.sides == 1 && !edge.is_tagged))
      for (const LineIndex line : edge.lines) result[line] = 0;
  return result;
}

LinePlan plan_lines(const MixedMesh& mesh, const Walls& walls, std::span<const double> heights,
                    std::span<const std::uint8_t> bare) {
  return Planner(mesh, walls, heights, bare).run();
}

}  // namespace hexpipe::assemble::layers
