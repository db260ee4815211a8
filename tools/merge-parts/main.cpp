#include <unistd.h>

#include "common/run/error.hpp"
#include "common/run/tool_main.hpp"
#include "tools/merge-parts/merges.hpp"

using namespace hexpipe;
using namespace hexpipe::merge_parts;

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "merge-parts",
      .summary = "Join parts or shares of candidates, graphs and solutions to the same bytes as those of a single run.",
      .example = "merge-parts graph-*.tar | initsol | lns | assemble -o engine.vtu",
      .reads = {},
      .product = std::nullopt,
  };
  MergePartsOptions options;
  const auto declare = [&](CLI::App& app) {
    app.add_option("parts", options.paths,
                   "Bundles of all parts of a mesh, or of all shares that --part 1/k to k/k made, these in order")
        ->required()
        ->type_name("FILE");
    app.add_option("-o,--output", options.output, "Write to a file, not to standard output")->type_name("FILE");
    app.add_flag("--compress", options.compress, "Compress the bundle with zstd");
  };
  const auto run = [&](RunContext&) {
    const bool to_stdout = options.output.empty() || options.output == "-";
    if (to_stdout && isatty(STDOUT_FILENO))
      throw UsageError("standard output is a terminal: pipe it to the next tool, or write a file with -o");
    merge_parts::merge_parts(options);
  };
  return tool_main(argc, argv, info, declare, run);
}
