// A hex that gave way, and vertices that made room for better cells, took volume from the hexes. Those that are left
// get it back from the cells between them: a vertex at which both meet moves out of its hexes. Their volume is linear
// in the place of one vertex, so that one gradient says what each step brings. Where it costs least goes first
// (objective.hpp).

#include <algorithm>
#include <array>
#include <vector>

#include "common/mesh/quality.hpp"
#include "tools/assemble/gap/passes.hpp"
#include "tools/assemble/gap/patch.hpp"

namespace hexpipe::assemble::gap {
namespace {

// No cell of the gap falls below this that was not below before: most of them are better, and that is what is spent.
constexpr double floor_of_growth = 0.2;
// What the volume of a mean hex may cost, in the objective: one round after the other.
constexpr std::array<double, 4> prices{2, 4, 8, 16};
// Parts of the shortest edge, the longest step first.
constexpr std::array<double, 3> steps_out{0.1, 0.05, 0.02};
constexpr int rounds_at_a_price = 3;

class HexGrower {
 public:
  explicit HexGrower(GapMesh& gap) : gap_(gap), patch_(gap, floor_of_growth) {}

  std::int64_t run(double wanted);

 private:
  std::vector<Vertex> beside_hexes() const;
  double mean_hex_volume() const;
  Vec3 gradient_at(Vertex v) const;
  double grow(Vertex v, double price, double wanted);

  GapMesh& gap_;
  Patch patch_;
};

std::vector<Vertex> HexGrower::beside_hexes() const {
  std::vector<Vertex> result;
  for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v)
    if (gap_.is_inside(v) && !gap_.cells_at(v).empty() && !gap_.is_free(v)) result.push_back(v);
  return result;
}

double HexGrower::mean_hex_volume() const {
  std::int64_t hexes = 0;
  for (const auto k : indices<KeptIndex>(gap_.kept_count()))
    hexes += gap_.kept_cell(k).is_alive && gap_.kept_cell(k).kind == CellKind::hex ? 1 : 0;
  return hexes > 0 ? hex_volume_of(gap_) / static_cast<double>(hexes) : 0;
}

Vec3 HexGrower::gradient_at(Vertex v) const {
  Vec3 sum{};
  for (const KeptIndex k : gap_.kept_at(v)) {
    const KeptCell& cell = gap_.kept_cell(k);
    if (cell.kind != CellKind::hex) continue;
    const auto at = corner_points(gap_.points(), cell.vertices());
    const auto own = static_cast<int>(std::ranges::find(cell.vertices(), v) - cell.vertices().begin());
    sum += cell_volume_gradient(cell.kind, std::span<const Vec3>(at).first(cell.vertices().size()), own);
  }
  return sum;
}

// Moves v out of its hexes, for no more volume than is wanted, if that costs at most `price` for each unit of it.
// Returns the volume gained.
double HexGrower::grow(Vertex v, double price, double wanted) {
  const Vec3 gradient = gradient_at(v);
  const double slope = norm(gradient);
  if (!(slope > 0)) return 0;
  const std::array<Vertex, 1> moving{v};
  patch_.take(moving, {});
  const double before = patch_.cost_before(), length = shortest_edge_at(gap_, v);
  for (const double part : steps_out) {
    const double step = std::min(part * length, wanted / slope), gained = step * slope;
    patch_.place(v, gap_.points()[v] + gradient * (step / slope));
    if (!patch_.keeps_floors() || !patch_.costs_at_most(before + price * gained)) continue;
    patch_.carry_out(gap_, {});
    return gained;
  }
  return 0;
}

std::int64_t HexGrower::run(double wanted) {
  if (!(wanted > 0)) return 0;
  const std::vector<Vertex> vertices = beside_hexes();
  const double hex_volume = mean_hex_volume();
  std::int64_t moves = 0;
  for (const double price : prices) {
    for (int round = 0; round < rounds_at_a_price; ++round) {
      const std::int64_t before = moves;
      for (const Vertex v : vertices) {
        if (!(wanted > 0)) return moves;
        const double gained = grow(v, price / hex_volume, wanted);
        wanted -= gained;
        moves += gained > 0 ? 1 : 0;
      }
      if (moves == before) break;
    }
  }
  return moves;
}

}  // namespace

std::int64_t grow_hexes(GapMesh& gap, double volume) {
  return HexGrower(gap).run(volume);
}

}  // namespace hexpipe::assemble::gap
