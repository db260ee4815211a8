#include "tools/tetmesh/improve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "common/run/deadline.hpp"
#include "common/run/parallel.hpp"
#include "common/run/progress.hpp"
#include "tools/tetmesh/search/point_search.hpp"
#include "tools/tetmesh/tetgen/run_tetgen.hpp"

namespace hexpipe::tetmesh {
namespace {

// TetGen never ends on a few meshes, and takes about the same time for all others. A run is given up when it has taken
// this many times the mean of the runs before, and at least this many seconds.
constexpr double most_times_the_mean = 50;
constexpr double least_limit = 5;

// Runs TetGen on many surfaces with points, one run for each thread at a time.
class MeshMaker {
 public:
  MeshMaker(double tetgen_timeout, const Deadline& deadline, TetmeshStatistics& statistics)
      : tetgen_timeout_(tetgen_timeout), deadline_(deadline), statistics_(statistics) {}

  void make(std::span<const search::SurfaceWithPoints> all, const search::TakeMesh& take);

 private:
  void start(const search::SurfaceWithPoints& wanted);
  double seconds_for_a_run() const;

  double tetgen_timeout_;
  const Deadline& deadline_;
  TetmeshStatistics& statistics_;
  std::deque<std::unique_ptr<tetgen::TetGenRun>> running_;
};

void MeshMaker::make(std::span<const search::SurfaceWithPoints> all, const search::TakeMesh& take) {
  const auto at_once = static_cast<std::size_t>(thread_count());
  std::size_t started = 0;
  const auto start_more = [&] {
    while (running_.size() < at_once && started < all.size() && !deadline_.passed()) start(all[started++]);
  };
  running_.clear();  // left by a call that threw
  start_more();
  for (std::size_t number = 0; !running_.empty(); ++number) {
    const std::unique_ptr<tetgen::TetGenRun> run = std::move(running_.front());
    running_.pop_front();
    try {
      tetgen::TetGenResult made = run->wait();
      ++statistics_.tetgen_runs;
      statistics_.seconds.of_tetgen += made.seconds;
      // TetGen makes the next mesh while this one is judged, unless there is only one thread.
      if (at_once > 1) start_more();
      take(number, tetgen::build_mesh(all[number].surface, all[number].inside, std::move(made)));
    } catch (const DataError&) {
      // TetGen failed or ran out of memory. The current mesh is still good.
    }
    start_more();
  }
}

void MeshMaker::start(const search::SurfaceWithPoints& wanted) {
  running_.push_back(std::make_unique<tetgen::TetGenRun>(tetgen::TetGenInput{.surface_points = wanted.surface.points,
                                                                             .triangles = wanted.surface.triangles,
                                                                             .interior_points = wanted.inside,
                                                                             .names_intersecting = false},
                                                         seconds_for_a_run()));
}

double MeshMaker::seconds_for_a_run() const {
  const double mean = statistics_.seconds.of_tetgen / std::max(1, statistics_.tetgen_runs);
  const double limit = std::max(least_limit, most_times_the_mean * mean);
  return std::min({limit, tetgen_timeout_, deadline_.remaining()});
}

}  // namespace

void improve(MeshedSurface& meshed, const solid::Surface& given, const ImproveOptions& options) {
  const Stopwatch watch;
  stop_searches_on_signal();
  const Deadline deadline(options.time_limit);
  TetmeshStatistics& statistics = meshed.statistics;
  Step step("moving points", 0.1, 1);
  if (options.time_limit) step.usually_takes(*options.time_limit);
  step.expect(static_cast<std::int64_t>(options.rounds));
  const auto after_round = [&](std::size_t round, double share) {
    step.advance();
    if (step.due()) step.say(fmt::format("round {}, about {:.1f} % in hexes", round + 1, 100 * share));
  };
  MeshMaker maker(options.tetgen_timeout, deadline, statistics);
  search::PointSearchResult found = search::search_points(
      meshed.surface(given), std::move(meshed.built),
      {.size = meshed.size,
       .seed = options.seed,
       .rounds = options.rounds,
       .changes_surface = meshed.made_surface.has_value(),
       .after_round = after_round},
      deadline,
      [&](std::span<const search::SurfaceWithPoints> all, const search::TakeMesh& take) { maker.make(all, take); });
  if (found.surface) meshed.made_surface = std::move(found.surface);
  meshed.built = std::move(found.built);
  statistics.improved = found.summary;
  statistics.interior_points =
      meshed.built.mesh.points.size() - meshed.surface(given).points.size() - meshed.built.added_points;
  statistics.seconds.improving += watch.seconds();
}

}  // namespace hexpipe::tetmesh
