#include "tools/assemble/layers/guide_surface.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "common/mesh/defaults.hpp"
#include "tools/assemble/shape/nearest_points.hpp"

namespace hexpipe::assemble::layers {
namespace {

// Alternate projections onto two faces end where they move a point by less than this fraction of their first move.
constexpr double settled = 1e-12;
constexpr int most_projections = 60;
const double cos_of_one_face = cosine_of_degrees(default_feature_angle);

}  // namespace

GuideFreedom freedom_of(std::span<const Guide> guides) {
  struct Face {
    Vec3 first, sum, inwards;
    std::int32_t tag;
  };
  std::vector<Face> faces;
  for (const Guide& guide : guides) {
    const auto face = std::ranges::find_if(faces, [&](const Face& f) {
      return f.tag == guide.tag && std::abs(dot(f.first, guide.normal)) > cos_of_one_face;
    });
    if (face == faces.end())
      faces.push_back({guide.normal, guide.normal, guide.inwards, guide.tag});
    else
      face->sum += dot(face->first, guide.normal) < 0 ? -guide.normal : guide.normal, face->inwards += guide.inwards;
  }
  GuideFreedom freedom;
  for (const Face& face : faces) freedom.tags.push_back(face.tag), freedom.inwards.push_back(face.inwards);
  if (faces.size() == 1) {
    freedom.kind = GuideFreedom::Kind::face;
    freedom.axis = unit(faces[0].sum);
  } else if (faces.size() == 2) {
    freedom.axis = unit(cross(unit(faces[0].sum), unit(faces[1].sum)));
    freedom.kind = norm_squared(freedom.axis) > 0 ? GuideFreedom::Kind::curve : GuideFreedom::Kind::none;
  } else if (faces.size() > 2) {
    freedom.kind = GuideFreedom::Kind::none;
  }
  if (freedom.tags.size() == 2 && freedom.tags[0] == freedom.tags[1]) freedom.tags.pop_back();
  return freedom;
}

GuideSurface::GuideSurface(const TetMesh& input, std::span<const std::int32_t> tags) : input_(input) {
  std::map<std::int32_t, std::vector<std::int32_t>> triangles_of;
  for (const std::int32_t tag : tags) triangles_of.try_emplace(tag);
  for (std::size_t t = 0; t < input.triangles.size(); ++t)
    if (const auto found = triangles_of.find(input.triangle_tags[t]); found != triangles_of.end())
      found->second.push_back(static_cast<std::int32_t>(t));
  for (auto& [tag, triangles] : triangles_of) {
    std::vector<Box> boxes;
    for (const std::int32_t t : triangles) {
      const auto& [a, b, c] = input.triangles[t];
      boxes.push_back(Box::around(std::array{input.points[a], input.points[b], input.points[c]}));
    }
    groups_.emplace(tag, Group{std::move(triangles), shape::tree_of(boxes)});
  }
}

Vec3 GuideSurface::nearest_on(std::int32_t tag, const Vec3& to) const {
  const auto found = groups_.find(tag);
  if (found == groups_.end()) return to;
  const Group& group = found->second;
  const auto point_of = [&](std::int32_t i) -> std::optional<Vec3> {
    const auto& [a, b, c] = input_.triangles[group.triangles[i]];
    return shape::nearest_on_triangle({input_.points[a], input_.points[b], input_.points[c]}, to);
  };
  return shape::nearest_in(group.tree, to, std::numeric_limits<double>::infinity(), point_of).value_or(to);
}

Vec3 GuideSurface::nearest(std::span<const std::int32_t> tags, Vec3 to) const {
  if (tags.empty()) return to;
  if (tags.size() == 1) return nearest_on(tags[0], to);
  double first_move = 0;
  for (int i = 0; i < most_projections; ++i) {
    const Vec3 at = nearest_on(tags[1], nearest_on(tags[0], to));
    const double move = norm(at - to);
    to = at;
    first_move = std::max(first_move, move);
    if (move <= settled * first_move) break;
  }
  return to;
}

}  // namespace hexpipe::assemble::layers
