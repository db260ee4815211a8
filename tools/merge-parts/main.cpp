#include <unistd.h>

#include "common/run/error.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/output_format.hpp"
#include "formats/streams/output.hpp"
#include "tools/merge-parts/merge_parts.hpp"
#include "tools/merge-parts/output_name.hpp"
#include "tools/merge-parts/pieces.hpp"

using namespace hexpipe;
using namespace hexpipe::merge_parts;

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "merge-parts",
      .summary = "Put parts or shares of candidates, graphs and solutions together, to the bytes of a single run.",
      .example = "merge-parts graph-*.tar | initsol | lns | assemble -o engine.vtu",
      .reads = {},
      .product = std::nullopt,
  };
  std::vector<std::string> paths;
  std::string path;
  bool compress = false;
  const auto declare = [&](CLI::App& app) {
    app.add_option("parts", paths,
                   "Bundles of all parts of a mesh, or of all shares that --part 1/k to k/k made, these in order")
        ->required()
        ->type_name("FILE");
    app.add_option("-o,--output", path, "Write to a file, not to standard output")->type_name("FILE");
    app.add_flag("--compress", compress, "Compress the bundle with zstd");
  };
  const auto run = [&](RunContext&) {
    const bool to_stdout = path.empty() || path == "-";
    if (to_stdout && isatty(STDOUT_FILENO))
      throw UsageError("standard output is a terminal: pipe it to the next tool, or write a file with -o");
    if (is_piece(paths.front())) {
      merge_pieces(paths, path, compress);
      return;
    }
    expect_bundle_or({}, path);
    formats::Output output(path);
    pipeline::BundleWriter writer(output, compress || pipeline::ending_of(path) == pipeline::compressed_bundle_format);
    merge_parts::merge_parts(paths, writer);
    writer.close();
    output.commit();
  };
  return tool_main(argc, argv, info, declare, run);
}
