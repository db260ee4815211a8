#include "tools/assemble/gap/room_filling.hpp"

#include <tsl/robin_map.h>

#include <array>
#include <cstdint>
#include <utility>

#include "common/mesh/quality.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

// So many hexes and prisms in a row are taken out of a body; more find nothing else.
constexpr int most_taken = 3;
// What a cell may be before vertices around it make room.
constexpr double least_before_raising = -0.3;
// No skin with fewer facets needs a vertex inside.
constexpr std::size_t least_facets_of_star = 6;
constexpr int steps_to_middle = 10;
// So many bodies are looked at for one room; nearly all rooms have a few dozen.
constexpr int most_bodies_looked_at = 2000;

// A number for these facets in any order. Two skins with one number cost one filling at most.
std::uint64_t number_of(std::span<const Facet> skin) {
  std::uint64_t number = 0;
  for (const Facet& facet : skin) {
    std::uint64_t own = 0;
    for (const Vertex v : facet.corners) own = (own ^ static_cast<std::uint32_t>(v)) * 0xbf58476d1ce4e5b9u;
    number += own ^ own >> 31;
  }
  return number;
}

class Filler {
 public:
  explicit Filler(const GapMesh& gap) : gap_(gap) {}

  std::optional<RoomFilling> fill(std::span<const Facet> skin, int taken, std::size_t most) {
    RoomFilling all;
    for (const auto& body : bodies_of(skin)) {
      auto filling = fill_body(body, taken, most - all.count);
      if (!filling) return std::nullopt;
      append(*filling, all);
    }
    return all.count < most ? std::optional(std::move(all)) : std::nullopt;
  }

 private:
  static void append(const RoomFilling& more, RoomFilling& all) {
    all.cells.insert(all.cells.end(), more.cells.begin(), more.cells.end());
    all.stars.insert(all.stars.end(), more.stars.begin(), more.stars.end());
    all.count += more.count;
  }

  bool is_hopeful(const Solid& solid) const {
    return quality_of(solid.kind, gap_.points(), solid.vertices()) > least_before_raising;
  }
  bool is_star(std::span<const Facet> body) const {
    return body.size() >= least_facets_of_star && is_ball(body) && middle_of_star(gap_.points(), body).worst > 0;
  }

  // The same cells taken out in another order leave the same.
  bool is_new(std::span<const Facet> skin, int taken) {
    const auto [seen, is_first] = least_taken_.insert({number_of(skin), taken});
    if (!is_first && seen->second <= taken) return false;
    seen.value() = taken;
    return true;
  }

  std::optional<RoomFilling> fill_body(const std::vector<Facet>& body, int taken, std::size_t most) {
    if (const auto solid = solid_of(body); solid && is_hopeful(*solid)) {
      const std::size_t count = solid->kind == CellKind::hex ? 0 : 1;
      return count < most ? std::optional(RoomFilling{{*solid}, {}, count}) : std::nullopt;
    }
    std::optional<RoomFilling> best;
    if (body.size() < most && is_star(body)) {
      best = RoomFilling{{}, {body}, body.size()};
      most = body.size();
    }
    if (taken == most_taken || ++looked_at_ > most_bodies_looked_at) return best;
    for (const Facet& facet : body) {
      const auto solid = solid_on(body, facet);
      if (!solid || !is_hopeful(*solid)) continue;
      const std::size_t own = solid->kind == CellKind::hex ? 0 : 1;
      const auto rest = skin_without(body, *solid);
      if (!rest || most <= own || !is_new(*rest, taken + 1)) continue;
      auto filling = fill(*rest, taken + 1, most - own);
      if (!filling) continue;
      append({{*solid}, {}, own}, *filling);
      most = filling->count;
      best = std::move(filling);
    }
    return best;
  }

  const GapMesh& gap_;
  tsl::robin_map<std::uint64_t, int> least_taken_;  // by what was left
  int looked_at_ = 0;
};

}  // namespace

std::optional<RoomFilling> fewest_cells(const GapMesh& gap, std::span<const Facet> skin, std::size_t most) {
  return Filler(gap).fill(skin, 0, most);
}

shape::Placement middle_of_star(std::span<const Vec3> points, std::span<const Facet> skin) {
  shape::PointStar star;
  for (const Facet& facet : skin) {
    const auto corners = facet.vertices();
    std::array<Vec3, 5> at{};
    for (std::size_t i = 0; i < corners.size(); ++i) at[i] = points[corners[corners.size() - 1 - i]];
    star.add(facet.is_quad() ? CellKind::pyramid : CellKind::tet, std::span<const Vec3>(at).first(corners.size() + 1),
             static_cast<int>(corners.size()));
  }
  return shape::raise_worst(star, middle_of(points, skin), steps_to_middle);
}

}  // namespace hexpipe::assemble::gap
