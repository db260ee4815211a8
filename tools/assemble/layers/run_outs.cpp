// Each line at a rim asks for the facets beside it that hide its wall, and gets all of them or none. A line that has a
// length without them, and stays on these facets then, refuses them to its neighbours. One that has none does not mind.

#include "tools/assemble/layers/run_outs.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "tools/assemble/layers/guide_surface.hpp"
#include "tools/assemble/layers/line_plan.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::layers {
namespace {

struct Wishes {
  std::vector<FacetVertices> facets;  // ascending
  bool can_do_without = false;        // the line has a length without them
};

// None where the line does well as it is, or would not do well then either.
Wishes wishes_of(const Line& line) {
  Wishes wishes;
  if (line.guides.empty()) return wishes;
  const double now = sight_of(line.normals, freedom_of(line.guides)).sine;
  wishes.can_do_without = now >= least_sight;
  if (line.normals.empty() || now >= full_sight) return wishes;
  const Vec3 into_part = unit(shape::shortest_in_hull(line.normals));
  std::vector<Vec3> normals = line.normals;
  std::vector<Guide> kept;
  for (const Guide& guide : line.guides) {
    if (!guide.is_outer || dot(unit(guide.inwards), into_part) >= full_sight) {
      kept.push_back(guide);
      continue;
    }
    normals.push_back(-guide.normal);
    wishes.facets.push_back(guide.facet);
  }
  if (sight_of(normals, freedom_of(kept)).sine < full_sight) wishes.facets.clear();
  std::ranges::sort(wishes.facets);
  return wishes;
}

std::vector<RunOut> find_run_outs(const Walls& walls) {
  struct Beside {
    std::vector<LineIndex> lines;
    bool is_refused = false;
  };
  std::map<FacetVertices, Beside> facets;
  std::vector<Wishes> wishes;
  for (std::size_t i = 0; i < walls.lines().size(); ++i) {
    wishes.push_back(wishes_of(walls.lines()[i]));
    for (const Guide& guide : walls.lines()[i].guides) facets[guide.facet].lines.push_back(LineIndex(i));
  }
  const auto layers_of = [&](LineIndex line) { return walls.lines()[line].layers; };
  const auto asks_for = [&](LineIndex line, const FacetVertices& facet) {
    return std::ranges::binary_search(wishes[line].facets, facet);
  };
  std::vector<FacetVertices> refused;
  const auto refuse_if_need_be = [&](const FacetVertices& facet, Beside& beside) {
    const bool is_asked_for = std::ranges::any_of(beside.lines, [&](LineIndex line) { return asks_for(line, facet); });
    const bool suits_all = std::ranges::all_of(beside.lines, [&](LineIndex line) {
      return layers_of(line) == layers_of(beside.lines[0]) && (asks_for(line, facet) || !wishes[line].can_do_without);
    });
    if (beside.is_refused || (is_asked_for && suits_all)) return;
    beside.is_refused = true;
    refused.push_back(facet);
  };
  for (auto& [facet, beside] : facets) refuse_if_need_be(facet, beside);
  // A line that does not get one of its wishes takes back the others.
  for (std::size_t next = 0; next < refused.size(); ++next)
    for (const LineIndex line : facets[refused[next]].lines) {
      if (!asks_for(line, refused[next])) continue;
      for (const FacetVertices& facet : std::exchange(wishes[line].facets, {})) refuse_if_need_be(facet, facets[facet]);
    }
  std::vector<RunOut> result;
  for (const auto& [facet, beside] : facets)
    if (!beside.is_refused) result.push_back({facet, layers_of(beside.lines[0])});
  return result;
}

}  // namespace

Walls walls_with_run_outs(const MixedMesh& mesh, std::span<const WallGroup> groups) {
  Walls walls(mesh, groups);
  const std::vector<RunOut> run_outs = find_run_outs(walls);
  return run_outs.empty() ? walls : Walls(mesh, groups, run_outs);
}

}  // namespace hexpipe::assemble::layers
