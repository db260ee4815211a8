#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <optional>

#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/progress.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/quads_of_choice.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/viewmesh/make_scene.hpp"
#include "tools/viewmesh/options.hpp"
#include "tools/viewmesh/page.hpp"
#include "tools/viewmesh/picture/picture.hpp"

using namespace hexpipe;
using namespace hexpipe::viewmesh;

namespace {

void write_outputs(const Scene& scene, const ViewState& state, const ViewmeshOptions& options) {
  if (!options.picture.empty()) {
    formats::Output output(options.picture);
    picture::write_png(picture::draw_picture(scene, state, options.title, options.size[0], options.size[1]), output);
    output.commit();
  }
  if (options.page.empty() && !options.picture.empty()) return;
  formats::Output output(options.page);
  write_page(scene, state, options.title, output);
  output.commit();
}

// The name of the file that was read; standard input has none.
std::string default_title(const StreamOptions& streams, Scene::Content content) {
  std::string path = streams.operand.value_or("-");
  if (path == "-" && !streams.files.empty()) path = streams.files.rbegin()->second;
  const std::string name = std::filesystem::path(path).filename();
  return path == "-" || name.empty() ? fmt::format("hexpipe {}", name_of(content)) : name;
}

}  // namespace

int main(int argc, char** argv) {
  const ToolInfo info{.name = "viewmesh",
                      .summary = "Show a mesh, a choice or candidates as a page for the browser, or as a picture.",
                      .example = "viewmesh bracket.vtu -o bracket.html --png bracket.png --view 'clip=y:0.5'",
                      .reads = {Role::result, Role::mesh, Role::candidates, Role::graph, Role::solution},
                      .product = std::nullopt};
  const std::map<std::string, Scene::Content> contents{{"result", Scene::Content::result},
                                                       {"solution", Scene::Content::solution},
                                                       {"candidates", Scene::Content::candidates},
                                                       {"mesh", Scene::Content::mesh}};
  ViewmeshOptions options;
  const auto declare = [&](CLI::App& app) {
    app.add_option("-o,--output", options.page,
                   "Write the page to a file; without -o and --png it goes to standard output")
        ->type_name("FILE");
    app.add_option("--png", options.picture, "Write a picture to a file")->type_name("FILE");
    begin_group(app, "Page and picture");
    app.add_option("--size", options.size, "Width and height of the picture in pixels")
        ->type_name("W,H")
        ->delimiter(',')
        ->expected(2)
        ->allow_extra_args(false)
        ->check(whole_number_between(16, 8192).description(""));
    app.add_option("--show", options.show,
                   "The stage to show: result, solution, candidates or mesh [the last one in the bundle]")
        ->type_name("WHAT")
        ->check(one_of(contents));
    app.add_option("--view", options.view,
                   "The view of page and picture, as the page's links have it after the #, for example "
                   "'clip=y:0.5&colour=quality&theme=dark' (man viewmesh has all keys)")
        ->group(group::first)
        ->type_name("STATE");
    app.add_option("--fragments", options.fragments,
                   "Fragments to go through one by one: each line has the numbers of a fragment's candidates, from 1")
        ->type_name("FILE");
    app.add_option("--title", options.title, "The title of page and legend [the file's name]")->type_name("TEXT");
  };
  const auto run = [&](RunContext& context) {
    ViewState state = parse_view_state(options.view);
    check(options);
    pipeline::Stage stage(context);
    std::optional<Step> step(std::in_place, "reading", 0, 0.4);
    // The number of weights: a solution chooses among as many.
    pipeline::StageData data = stage.read({.wants = {Role::mesh, Role::candidates, Role::solution, Role::result},
                                           .dislocations = true,
                                           .weights_only = true});
    pipeline::drop_quads(data);
    const std::string source = !context.streams.operand || context.streams.operand == "-"
                                   ? context.streams.files.empty() ? "stdin" : "the files"
                                   : *context.streams.operand;
    const Scene::Content content = options.show.empty() ? last_content(data, source) : contents.at(options.show);
    step.emplace("measuring cells", 0.4, 0.7);
    Scene scene = make_scene(std::move(data), content, source);
    resolve_groups(state, scene);
    check_colour(state, scene);
    if (!options.fragments.empty()) {
      if (content != Scene::Content::candidates && content != Scene::Content::solution)
        throw UsageError("--fragments: expected candidates or a solution to show them in (see --show)");
      formats::Input input = formats::Input::open(options.fragments);
      read_fragments(scene, input);
    }
    for (std::size_t k = 0; k < scene_kinds.size(); ++k)
      context.statistics[name_of(scene_kinds[k])] = scene.kind_begin[k + 1] - scene.kind_begin[k];
    context.note(fmt::format("{}: {} cells", name_of(content), scene.cell_count()));
    if (options.title.empty()) options.title = default_title(context.streams, content);
    step.emplace("drawing", 0.7);
    write_outputs(scene, state, options);
  };
  return tool_main(argc, argv, info, declare, run);
}
