#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>

#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/messages.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/tool_main.hpp"
#include "tools/hexpipe/plan.hpp"
#include "tools/hexpipe/run_stages.hpp"

using namespace hexpipe;
using namespace hexpipe::front_door;

namespace {

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw DataError::at(folder, "cannot make the folder: {}", error.message());
}

void print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) throw DataError("stdout: cannot write");
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, Effort> efforts{
      {"quick", Effort::quick}, {"usual", Effort::usual}, {"thorough", Effort::thorough}};
  const ToolInfo info{.name = "hexpipe",
                      .summary = "Mesh a surface or a CAD file in one command: runs the usual pipe of tools.",
                      .example = "hexpipe bracket.stl --size 3 -o bracket.msh --page bracket.html",
                      .reads = {},
                      .product = std::nullopt};
  PipeOptions options;
  std::string effort = "usual";
  std::uint64_t seed = 1;
  bool dry_run = false;
  const CLI::App* command_line = nullptr;
  const auto declare = [&](CLI::App& app) {
    command_line = &app;
    app.add_option("input", options.input, "A surface (STL, OBJ, PLY, OFF, 3MF), or CAD (STEP, IGES, BREP, FreeCAD)")
        ->type_name("FILE")
        ->default_str("");
    app.add_option("--size", options.size,
                   "Edge length of the hexes; with %, of the bounding box's diagonal [one that suits the model]")
        ->type_name("LENGTH");
    app.add_option("-o,--output", options.output, "The mesh, in the format that the ending names")
        ->type_name("FILE")
        ->default_str("");
    app.add_option("--solver", options.solver, "The program that the mesh is for, as assemble knows it")
        ->type_name("NAME");
    begin_group(app, "To look at it");
    app.add_option("--page", options.page, "A page that shows it, for a browser")->type_name("FILE");
    app.add_option("--png", options.picture, "A picture of it")->type_name("FILE");
    app.add_option("--effort", effort,
                   "quick: seconds for the choice of hexes; thorough: minutes, also for a search for better points")
        ->group(group::first)
        ->check(one_of(efforts));
    begin_group(app, "Stages");
    app.add_option("--mesh", options.mesh, "Tets of another program, instead of a surface")->type_name("FILE");
    app.add_option("--keep", options.keep, "Keep what each stage makes in this folder, as NAME.tar")
        ->type_name("FOLDER");
    app.add_option("--from", options.from, "Go on from what an earlier run kept")
        ->type_name("NAME:{surface,mesh,candidates,conflicts,solution,choice,result}");
    app.add_option("--seed", seed, "Seed of the random numbers of all stages")->type_name("N");
    app.add_flag("--dry-run", dry_run, "Print the pipe as a shell command, and do nothing");
    begin_group(app, "Options of a stage");
    for (const char* tool :
         {"tessellate", "tetmesh", "findhex", "buildgraph", "initsol", "lns", "assemble", "fitcad", "viewmesh"})
      app.add_option_function<std::string>(
             fmt::format("--{}", tool), [&, tool](const std::string& words) { options.stage_options[tool] = words; },
             fmt::format("More options of {}, in quotes", tool))
          ->type_name("'OPTIONS'");
  };
  const auto run_pipe = [&](RunContext& context) {
    options.effort = efforts.at(effort);
    if (command_line->count("--threads") > 0) options.threads = context.common.threads;
    if (command_line->count("--seed") > 0) options.seed = seed;
    const Plan plan = plan_of(options);
    if (dry_run) return print(as_shell(plan));
    if (plan.folder) make_folder(*plan.folder);
    stop_searches_on_signal();
    const Stopwatch watch;
    for (StageOutcome& outcome : run(plan, {.quiet = context.common.quiet, .verbose = context.common.verbose})) {
      if (outcome.tool == plan.pipe.back().tool && outcome.statistics.is_object() && !context.common.quiet)
        for (const std::string& line : summary_of(outcome.statistics, options.output, watch.seconds()))
          print_message(info.name, line);
      context.statistics[outcome.tool] = std::move(outcome.statistics);
    }
  };
  return tool_main(argc, argv, info, declare, run_pipe);
}
