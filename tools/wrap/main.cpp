#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <string>
#include <utility>
#include <vector>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/defaults.hpp"
#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/surface_file.hpp"
#include "formats/streams/output.hpp"
#include "tools/wrap/wrap.hpp"

using namespace hexpipe;

namespace {

formats::SurfaceSoup read_surface(const std::string& path, std::vector<nlohmann::ordered_json>& history) {
  if (path == "-" && isatty(STDIN_FILENO))
    throw UsageError("nothing to read: name a surface, or pipe one to standard input (see wrap --help)");
  return pipeline::read_surface_file(path, &history);
}

// "3", or "2%" of the diagonal of the surface's box.
double parse_gap(const std::string& text, const formats::SurfaceSoup& surface) {
  const bool percent = text.ends_with('%');
  double value = 0;
  const char* const last = text.data() + text.size() - (percent ? 1 : 0);
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc() || end != last || !(value > 0))
    throw UsageError(
        fmt::format("--gap: expected a positive length, or a percentage of the diagonal, found '{}'", text));
  const double diagonal = Box::around(surface.points).diagonal();
  const double gap = percent ? value / 100 * diagonal : value;
  if (gap > diagonal || gap < wrap::least_gap_of_diagonal * diagonal)
    throw UsageError(fmt::format("--gap: expected from {:g} to the diagonal of the surface, {:.6g}, found {:.6g}",
                                 wrap::least_gap_of_diagonal * diagonal, diagonal, gap));
  return gap;
}

std::string summary(const wrap::WrapResult& result) {
  return fmt::format(
      "{} triangles, {:.3g} from the input at most and {:.3g} in the mean; the input is {:.3g} from them "
      "at most, {:.3g} in the mean",
      result.surface.triangles.size(), result.to_input.greatest, result.to_input.mean, result.from_input.greatest,
      result.from_input.mean);
}

}  // namespace

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "wrap",
      .summary = "Put a closed surface around any triangles: open ones, crossing ones, a soup.",
      .example = "wrap scan.obj --gap 2% | tetmesh --size 3 | findhex | buildgraph | initsol | assemble -o scan.vtu",
      .reads = {},
      .product = std::nullopt,
      .licence = "GPL-3.0, because it links the GPL parts of CGAL",
  };
  std::string path = "-", gap = "2%", output_path;
  wrap::WrapOptions options{.gap = 0, .feature_angle = default_feature_angle, .features = true};
  bool compress = false;
  const auto declare = [&](CLI::App& app) {
    app.add_option("file", path, "Triangles in any surface format, or a bundle; '-' or nothing: standard input")
        ->type_name("FILE");
    app.add_option("--gap", gap,
                   "Close holes and gaps narrower than this, a length or a percentage of the diagonal; finer detail is "
                   "lost inside corners")
        ->type_name("WIDTH")
        ->capture_default_str();
    app.add_option("--feature-angle", options.feature_angle,
                   "Bring back the input's edges where its surface turns by more than this, in degrees")
        ->check(number_between(1, 180))
        ->type_name("ANGLE")
        ->capture_default_str();
    app.add_flag("!--no-features", options.features, "Bring no sharp edges back");
    outside_history(
        app.add_option("-o,--output", output_path, "Write to a file, not to standard output: .tar, .obj, .stl or .msh"))
        ->type_name("FILE");
    outside_history(app.add_flag("--compress", compress, "Compress the bundle with zstd"));
  };
  const auto run = [&](RunContext& context) {
    const std::string_view format = pipeline::surface_format_of(output_path);
    std::vector<nlohmann::ordered_json> history;
    const formats::SurfaceSoup soup = read_surface(path, history);
    for (const std::string& warning : soup.warnings) context.warn(warning);
    options.gap = parse_gap(gap, soup);
    const wrap::WrapResult result = wrap::wrap(soup, options);
    for (const std::string& warning : result.warnings) context.warn(soup.name + ": " + warning);
    formats::Output output(output_path);
    if (format.empty()) {
      nlohmann::ordered_json entry = pipeline::history_entry_of(context);
      entry.update(to_json(result));
      history.push_back(std::move(entry));
      pipeline::write_surface_bundle(result.surface, history,
                                     compress || pipeline::ending_of(output_path) == pipeline::compressed_bundle_format,
                                     output);
    } else {
      for (const std::string& change : pipeline::write_surface(result.surface, format, output)) context.warn(change);
    }
    output.commit();
    context.note(summary(result));
    context.statistics.update(to_json(result));
  };
  return tool_main(argc, argv, info, declare, run);
}
