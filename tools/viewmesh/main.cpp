#include <fmt/format.h>
#include <unistd.h>

#include <map>

#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/viewmesh/page.hpp"
#include "tools/viewmesh/picture.hpp"

using namespace hexpipe;
using namespace hexpipe::viewmesh;

namespace {

struct Outputs {
  std::string page, picture;
  std::vector<int> size{1600, 1000};
};

// -o picture.png is soon typed, and would write a page under the name of a picture.
void check_endings(const Outputs& outputs) {
  if (outputs.page.ends_with(".png"))
    throw UsageError(
        fmt::format("-o writes a page: expected another name than '{0}' (a picture: --png {0})", outputs.page));
  if (outputs.picture.ends_with(".html") || outputs.picture.ends_with(".htm"))
    throw UsageError(
        fmt::format("--png writes a picture: expected another name than '{0}' (a page: -o {0})", outputs.picture));
}

void write_outputs(const Scene& scene, const ViewState& state, const std::string& title, const Outputs& outputs) {
  if (!outputs.picture.empty()) {
    formats::Output output(outputs.picture);
    write_png(draw_picture(scene, state, outputs.size[0], outputs.size[1]), output);
    output.commit();
  }
  if (outputs.page.empty() && !outputs.picture.empty()) return;
  formats::Output output(outputs.page);
  write_page(scene, state, title, output);
  output.commit();
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
  Outputs outputs;
  std::string show, view, title, fragments;
  const auto declare = [&](CLI::App& app) {
    app.add_option("-o,--output", outputs.page, "Write the page to a file; without it and --png: to standard output")
        ->type_name("FILE");
    app.add_option("--png", outputs.picture, "Write a picture to a file")->type_name("FILE");
    app.add_option("--size", outputs.size, "Width and height of the picture in pixels")
        ->type_name("W,H")
        ->delimiter(',')
        ->expected(2)
        ->allow_extra_args(false)
        ->check(CLI::Range(16, 8192).description(""));
    app.add_option("--show", show, "What to show: result, solution, candidates or mesh [the last that is there]")
        ->type_name("WHAT")
        ->check(CLI::IsMember(contents).description(""));
    app.add_option("--view", view,
                   "How the page opens and the picture is taken, as links of the page say it behind the #, for example "
                   "'clip=y:0.5&colour=quality&theme=dark' (man viewmesh has all keys)")
        ->type_name("STATE");
    app.add_option("--fragments", fragments,
                   "Fragments to go through one by one: a line each, the numbers of its candidates, from 1")
        ->type_name("FILE");
    app.add_option("--title", title, "The page's title")->type_name("TEXT");
  };
  const auto run = [&](RunContext& context) {
    const ViewState state = parse_view_state(view);
    check_endings(outputs);
    if (outputs.page.empty() && outputs.picture.empty() && isatty(STDOUT_FILENO))
      throw UsageError("standard output is a terminal: write the page to a file with -o, or a picture with --png");
    pipeline::Stage stage(context);
    stage.take_weights();  // for their number: a solution chooses among as many
    pipeline::StageData data = stage.read({}, {Role::mesh, Role::candidates, Role::solution, Role::result});
    const std::string source = !context.streams.operand || context.streams.operand == "-"
                                   ? context.streams.files.empty() ? "stdin" : "the files"
                                   : *context.streams.operand;
    const Scene::Content content = show.empty() ? last_content(data, source) : contents.at(show);
    Scene scene = make_scene(std::move(data), content, source);
    if (!fragments.empty()) {
      if (content != Scene::Content::candidates && content != Scene::Content::solution)
        throw UsageError("--fragments: expected candidates or a solution to show them in (see --show)");
      formats::Input input = formats::Input::open(fragments);
      read_fragments(scene, input);
    }
    for (std::size_t k = 0; k < scene_kinds.size(); ++k)
      context.statistics[name_of(scene_kinds[k])] = scene.kind_begin[k + 1] - scene.kind_begin[k];
    context.note(fmt::format("{}: {} cells", name_of(content), scene.cell_count()));
    write_outputs(scene, state, title.empty() ? fmt::format("hexpipe {}", name_of(content)) : title, outputs);
  };
  return tool_main(argc, argv, info, declare, run);
}
