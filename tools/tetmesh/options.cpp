#include "tools/tetmesh/options.hpp"

#include <fmt/format.h>

#include <initializer_list>
#include <string_view>

#include "common/run/error.hpp"
#include "tools/tetmesh/volume/frame_points.hpp"

namespace hexpipe::tetmesh {
namespace {

// A number, also one outside the range of the option: CLI11 refuses that.
bool is_value(std::string_view word) {
  return word != "-" && word.find_first_not_of("+-.0123456789") == std::string_view::npos;
}

bool is_option(std::string_view word) {
  return word.size() > 1 && word.front() == '-';
}

}  // namespace

std::vector<char*> words_for_parsing(int argc, char** argv) {
  static char layers_without_value[] = "--layers=2", angle_without_value[] = "--tags-by-angle=40";
  std::vector<char*> words(argv, argv + argc);
  for (std::size_t i = 1; i + 1 < words.size() && words[i] != std::string_view("--"); ++i)
    for (char* with_value : {layers_without_value, angle_without_value}) {
      const std::string_view option = std::string_view(with_value).substr(0, std::string_view(with_value).find('='));
      if (words[i] == option && !is_option(words[i + 1]) && !is_value(words[i + 1])) words[i] = with_value;
    }
  return words;
}

void refuse_idle_options(const std::function<bool(const char*)>& is_given, const TetmeshOptions& options,
                         const std::string& points) {
  const auto refuse = [&](std::initializer_list<const char*> idle, const std::string& when) {
    for (const char* name : idle)
      if (is_given(name)) throw UsageError(fmt::format("{} does nothing {}", name, when));
  };
  const bool keeps = options.surface == SurfaceKind::keep, places = places_points(options.points);
  if (!options.repair) refuse({"--weld", "--largest-hole"}, "without --repair");
  if (!is_given("--size-field") && !is_given("--layers") && options.asked_sizes.empty() && !options.sizes.curvature)
    refuse({"--grading"}, "without --size-field, --layers, --curvature or a --size at a place");
  if (!options.sizes.curvature) refuse({"--least-size"}, "without --curvature");
  if (options.improve == 0) refuse({"--time-limit"}, "without --improve");
  if (keeps) refuse({"--deviation", "--short-features", "--stretch"}, "with --surface keep");
  if (!places) refuse({"--clearance", "--jitter", "--improve"}, "with --points " + points);
  if (keeps && !places) refuse({"--feature-angle"}, "with --surface keep and --points " + points);
  // With points of the user's own, these options say how near to the surface the points may be.
  if (keeps && options.points == PointKind::none)
    refuse({"--size-field", "--layers", "--curvature"}, "with --surface keep and --points none");
}

void check_options(const TetmeshOptions& options) {
  if (options.tries.value_or(1) > 1 && options.surface == SurfaceKind::keep && !places_points(options.points))
    throw UsageError("--tries has no sizes to try with --surface keep and without points to place");
  if (const auto given = static_cast<double>(options.given_points.points.size()); given > options.most_points)
    throw DataError::at(options.given_points.name, "expected at most {:g} points (see --most-points), found {:g}",
                        options.most_points, given);
  // Each coordinate moves by the jitter, a point by up to sqrt(3) times that; it must not reach the surface.
  if (!places_points(options.points)) return;
  const double jitter = options.jitter.value_or(volume::FramePointsOptions{}.jitter);
  if (jitter >= options.clearance / 2)
    throw UsageError(
        fmt::format("expected --jitter below half of --clearance, {:g}, found {:g}", options.clearance / 2, jitter));
}

}  // namespace hexpipe::tetmesh
