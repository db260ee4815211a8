#include "tools/tetmesh/search/point_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "common/run/parallel.hpp"
#include "common/run/random.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"
#include "tools/tetmesh/search/judged_mesh.hpp"
#include "tools/tetmesh/search/point_change.hpp"
#include "tools/tetmesh/solid/surface_clearance.hpp"

namespace hexpipe::tetmesh::search {
namespace {

constexpr std::size_t tries_a_place = 4;        // changes tried at a place in a round
constexpr double reach = 2.5;                   // how far a change may bring or cost something, in sizes
constexpr double first_kicks = 5, kicks = 0.5;  // for each hex, see choose_hexes()
constexpr double least_gain = 1e-3;             // in cubes of the size

struct Place {
  Vec3 middle;
  double size;
  TetIndex tet;  // one that is left
};

class PointSearch {
 public:
  PointSearch(const solid::Surface& surface, tetgen::BuiltMesh start, const PointSearchOptions& options,
              const MakeMeshes& make_meshes)
      : options_(options),
        make_meshes_(make_meshes),
        given_surface_(surface),
        clearance_(surface),
        box_(geometry::Box::around(surface.points)),
        current_(judged(std::move(start))),
        index_(current_.built.mesh) {}

  // Returns the number of changes that stay.
  std::size_t run_round(std::size_t round);
  tetgen::BuiltMesh take_mesh() { return std::move(current_.built); }
  // Nothing if it did not change.
  std::optional<solid::Surface> take_surface() { return std::move(changed_surface_); }
  double hex_volume() const { return current_.hex_volume(); }
  bool is_complete() const { return current_.left.empty(); }

 private:
  std::vector<Place> choose_places(Random& random) const;
  std::vector<std::vector<PointChange>> draw_changes(std::span<const Place> places, Random& random) const;
  std::vector<const PointChange*> best_changes(std::span<const Place> places,
                                               std::span<const std::vector<PointChange>> changes,
                                               std::span<const std::vector<double>> worth) const;
  std::vector<double> worth_around(std::span<const Place> places, const JudgedMesh& judged) const;
  const solid::Surface& surface() const { return changed_surface_ ? *changed_surface_ : given_surface_; }
  SurfaceWithPoints with(std::span<const PointChange* const> changes) const;
  bool take_if_better(std::span<const PointChange* const> changes);
  static JudgedMesh judged(tetgen::BuiltMesh start);
  JudgedMesh judged_from_current(tetgen::BuiltMesh built) const;

  const PointSearchOptions& options_;
  const MakeMeshes& make_meshes_;
  const solid::Surface& given_surface_;
  const solid::SurfaceClearance clearance_;  // also serves all changed surfaces, because they lie in the same place
  const geometry::Box box_;
  std::optional<solid::Surface> changed_surface_;
  JudgedMesh current_;
  MeshIndex index_;  // of the current mesh
};

std::size_t PointSearch::run_round(std::size_t round) {
  Random random(options_.seed, round);
  const std::vector<Place> places = choose_places(random);
  const std::vector<std::vector<PointChange>> changes = draw_changes(places, random);
  std::vector<SurfaceWithPoints> variants;
  for (const std::vector<PointChange>& of_try : changes) {
    std::vector<const PointChange*> all;
    for (const PointChange& change : of_try) all.push_back(&change);
    variants.push_back(with(all));
  }
  std::vector<std::vector<double>> worth(tries_a_place);  // by try and place, as the changes; empty where TetGen failed
  make_meshes_(variants, [&](std::size_t number, tetgen::BuiltMesh built) {
    worth[number] = worth_around(places, judged_from_current(std::move(built)));
  });
  std::vector<const PointChange*> good = best_changes(places, changes, worth);
  // If all changes together bring nothing, the best ones may.
  for (int attempt = 0; attempt < 2 && !good.empty(); ++attempt) {
    if (take_if_better(good)) return good.size();
    good.resize(good.size() / 2);
  }
  return 0;
}

// By try and place.
std::vector<std::vector<PointChange>> PointSearch::draw_changes(std::span<const Place> places, Random& random) const {
  std::optional<FlatSurface> flat;
  if (options_.changes_surface) flat.emplace(surface());
  const ChangeDrawer drawer(current_, static_cast<Vertex>(surface().points.size()), clearance_,
                            flat ? &*flat : nullptr);
  std::vector<std::vector<PointChange>> changes(tries_a_place);
  for (std::vector<PointChange>& of_try : changes)
    for (const Place& place : places) of_try.push_back(drawer.draw(place.tet, place.middle, place.size, random));
  return changes;
}

// The best change of each place that has a good one, those that bring most first.
std::vector<const PointChange*> PointSearch::best_changes(std::span<const Place> places,
                                                          std::span<const std::vector<PointChange>> changes,
                                                          std::span<const std::vector<double>> worth) const {
  const std::vector<double> before = worth_around(places, current_);
  std::vector<std::pair<double, const PointChange*>> good;
  for (std::size_t p = 0; p < places.size(); ++p) {
    const double size = places[p].size;
    std::pair<double, const PointChange*> best{least_gain * size * size * size, nullptr};
    for (std::size_t t = 0; t < changes.size(); ++t)
      if (!worth[t].empty() && !changes[t][p].is_nothing() && worth[t][p] - before[p] > best.first)
        best = {worth[t][p] - before[p], &changes[t][p]};
    if (best.second != nullptr) good.push_back(best);
  }
  std::ranges::stable_sort(good, std::greater(), &std::pair<double, const PointChange*>::first);
  std::vector<const PointChange*> sorted;
  for (const auto& [gain, change] : good) sorted.push_back(change);
  return sorted;
}

// Chooses tets that are left, so far apart that changes at one do not reach another.
std::vector<Place> PointSearch::choose_places(Random& random) const {
  const TetMesh& mesh = current_.built.mesh;
  std::vector<TetIndex> order = current_.left;
  random.shuffle(std::span(order));
  std::vector<Place> places;
  geometry::SizedPointGrid chosen(box_);
  for (const TetIndex t : order) {
    const Tet& corners = mesh.tets[t];
    const Vec3 middle =
        0.25 * (mesh.points[corners[0]] + mesh.points[corners[1]] + mesh.points[corners[2]] + mesh.points[corners[3]]);
    const double size = options_.size.at(middle);
    bool is_apart = true;
    chosen.for_each_near(middle, reach * (size + options_.size.greatest()), 0, [&](std::int32_t other) {
      const double apart = reach * (size + places[other].size);
      return is_apart = norm_squared(places[other].middle - middle) >= apart * apart;
    });
    if (!is_apart) continue;
    chosen.add(middle, reach * size);
    places.push_back({middle, size, t});
  }
  return places;
}

// The worth of the hexes within reach of each place; hexes at the rim count less.
std::vector<double> PointSearch::worth_around(std::span<const Place> places, const JudgedMesh& judged) const {
  std::vector<double> worth(places.size());
  parallel_for(static_cast<std::int64_t>(places.size()), 1, [&](std::int64_t p) {
    const double radius = reach * places[p].size;
    double sum = 0;
    for (std::size_t h = 0; h < judged.middles.size(); ++h) {
      const double squared = norm_squared(judged.middles[h] - places[p].middle);
      if (squared < radius * radius) sum += judged.worth[h] * std::min(1.0, 2 - 2 * std::sqrt(squared) / radius);
    }
    worth[p] = sum;
  });
  return worth;
}

SurfaceWithPoints PointSearch::with(std::span<const PointChange* const> changes) const {
  std::vector<Vec3> all = current_.built.mesh.points;
  std::vector<bool> removed(all.size());
  std::vector<Vec3> added;
  std::vector<const SurfaceChange*> on_surface;
  for (const PointChange* change : changes) {
    for (const auto& [v, place] : change->moved) all[v] = place;
    for (const Vertex v : change->removed) removed[v] = true;
    added.insert(added.end(), change->added.begin(), change->added.end());
    if (!change->on_surface.is_nothing()) on_surface.push_back(&change->on_surface);
  }
  SurfaceWithPoints changed{on_surface.empty() ? surface() : with_changes(surface(), on_surface), {}};
  for (std::size_t v = surface().points.size(); v < all.size(); ++v)
    if (!removed[v]) changed.inside.push_back(all[v]);
  changed.inside.insert(changed.inside.end(), added.begin(), added.end());
  return changed;
}

bool PointSearch::take_if_better(std::span<const PointChange* const> changes) {
  std::optional<JudgedMesh> next;
  std::vector<SurfaceWithPoints> changed;
  changed.push_back(with(changes));
  make_meshes_(changed, [&](std::size_t, tetgen::BuiltMesh built) { next = judged_from_current(std::move(built)); });
  if (!next || next->total_worth() <= current_.total_worth()) return false;
  current_ = std::move(*next);
  index_ = MeshIndex(current_.built.mesh);
  if (options_.changes_surface) changed_surface_ = std::move(changed.front().surface);
  return true;
}

JudgedMesh PointSearch::judged(tetgen::BuiltMesh start) {
  std::vector<ChosenHex> hexes = choose_hexes(start.mesh, first_kicks);
  return judge(std::move(start), std::move(hexes));
}

JudgedMesh PointSearch::judged_from_current(tetgen::BuiltMesh built) const {
  const MeshChange change(index_, built.mesh);
  std::vector<ChosenHex> hexes = choose_hexes_again(built.mesh, change, current_.hexes, kicks);
  return judge(std::move(built), std::move(hexes));
}

}  // namespace

PointSearchResult search_points(const solid::Surface& surface, tetgen::BuiltMesh start,
                                const PointSearchOptions& options, const Deadline& deadline,
                                const MakeMeshes& make_meshes) {
  const double volume = surface.volume();
  PointSearch search(surface, std::move(start), options, make_meshes);
  PointSearchSummary summary{.share_before = search.hex_volume() / volume};
  for (; summary.rounds < options.rounds && !search.is_complete() && !deadline.passed(); ++summary.rounds) {
    summary.changes += search.run_round(summary.rounds);
    if (options.after_round) options.after_round(summary.rounds, search.hex_volume() / volume);
  }
  summary.share = search.hex_volume() / volume;
  return {search.take_surface(), search.take_mesh(), summary};
}

}  // namespace hexpipe::tetmesh::search
