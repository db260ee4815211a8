#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/run/error.hpp"
#include "tests/fuzz/scratch_files.hpp"
#include "tests/fuzz/tar_members.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/fuzz/tool_run.hpp"

// Each is the main() of a tool: CMakeLists.txt.
extern "C" {
int findhex_main(int argc, char** argv);
int buildgraph_main(int argc, char** argv);
int initsol_main(int argc, char** argv);
int lns_main(int argc, char** argv);
int certify_main(int argc, char** argv);
int assemble_main(int argc, char** argv);
int merge_parts_main(int argc, char** argv);
int mesh_part_main(int argc, char** argv);
int viewmesh_main(int argc, char** argv);
}

namespace hexpipe {
namespace {

using Options = std::vector<std::string>;

struct FuzzedTool {
  const char* name;
  int (*main)(int, char**);
  std::vector<Options> choices;  // the first byte of the input is for one of them
  std::size_t alone = 0;         // this many of the last ones leave later tools nothing, or need what is missing
};

// Larger meshes take long under the sanitizers and have no more to show.
constexpr std::size_t largest_mesh = 6000;  // bytes

const FuzzedTool findhex{"findhex",
                         findhex_main,
                         {{},
                          {"--cells", "hex,prism,pyramid"},
                          {"--cells", "hex,prism,pyramid", "--min-quality", "0", "--flat-corners", "keep"},
                          {"--cells", "prism,pyramid", "--inner-vertices", "forbid", "--folded-quads", "keep"},
                          {"--cells", "hex,pyramid", "--quality", "corner", "--max-boundary-tets", "0"},
                          {"--part", "2/3"}}};
const FuzzedTool buildgraph{"buildgraph",
                            buildgraph_main,
                            {{},
                             {"--reduce"},
                             {"--cover"},
                             {"--reduce", "--cover", "--weight", "quality*volume"},
                             {"--weight", "volume", "--weight-scale", "1e3"},
                             {"--weight", "count", "--part", "1/2"}},
                            1};
const FuzzedTool initsol{"initsol",
                         initsol_main,
                         {{"--iterations", "100"},
                          {"--iterations", "20", "--greedy", "quality", "--method", "descend"},
                          {"--iterations", "100", "--method", "tabu", "--patience", "3"},
                          {"--iterations", "10", "--greedy", "weight", "--starts", "2"}}};
const FuzzedTool lns{"lns",
                     lns_main,
                     {{"--iterations", "20"},
                      {"--iterations", "20", "--no-reductions", "--fragment-size", "5"},
                      {"--iterations", "5", "--target-gap", "0.5"}},
                     1};
const FuzzedTool certify{
    "certify", certify_main, {{"--iterations", "20"}, {"--iterations", "5", "--exact", "--time-limit", "1"}}};
const FuzzedTool assemble{
    "assemble", assemble_main, {{}, {"--smooth", "0"}, {"--conformity", "none"}, {"--format", "msh"}}};
const FuzzedTool merge_parts{"merge-parts", merge_parts_main, {{}, {"--compress"}}};
#ifdef HEXPIPE_FUZZES_MESH_PART
const FuzzedTool mesh_part{"mesh-part", mesh_part_main, {{"--parts", "1"}, {"--parts", "2"}, {"--parts", "5"}}};
#endif
#ifdef HEXPIPE_FUZZES_VIEW
const FuzzedTool viewmesh{
    "viewmesh",
    viewmesh_main,
    {{}, {"--show", "mesh"}, {"--show", "candidates"}, {"--show", "solution"}, {"--show", "result"}}};
#endif

const ScratchFiles& scratch() {
  static const ScratchFiles files;
  return files;
}

// Throws a DataError where the tool ends with one. `bytes` are those that the input was made of.
void run(const FuzzedTool& tool, const Options& options, const std::string& input, const std::string& output,
         std::string_view bytes) {
  std::filesystem::remove_all(output);
  std::vector<std::string> arguments{tool.name, "-q", "--threads", "1", input, "-o", output};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto [code, message] = run_tool(tool.main, arguments);
  const bool made = std::filesystem::exists(output);
  if (code == 0) {
    promise(made, "a tool that has done its work has an output");
    promise(message.empty(), "a tool that has done its work is silent: " + message);
  } else {
    promise(code == 1, "bad data is exit code 1: " + message);
    promise(!made, "a tool that refuses its input has no output");
    promise(is_message_of(tool.name, message, bytes), "a message is a line of ours: " + message);
  }
  if (code != 0) throw DataError(message);
}

std::size_t first_byte(std::string_view bytes) {
  return static_cast<unsigned char>(bytes.front());
}

// The first byte chooses options, the others are a bundle, which gets right checksums.
void run_on_bundle(const FuzzedTool& tool, std::string_view bytes) {
  if (bytes.empty()) return;
  const std::string input = scratch().write("in.tar", with_right_checksums(bytes.substr(1)));
  run(tool, tool.choices[first_byte(bytes) % tool.choices.size()], input, scratch().path("out.tar"), bytes);
}

// The first byte chooses options, the others are a mesh in any format: what a tool makes is taken by the next.
void run_pipeline(std::string_view bytes) {
  if (bytes.empty() || bytes.size() > largest_mesh) return;
  std::size_t choice = first_byte(bytes);
  std::string input = scratch().write("in.mesh", bytes.substr(1));
  for (const FuzzedTool* tool : {&findhex, &buildgraph, &initsol, &lns, &certify, &assemble}) {
    const std::string output = scratch().path(std::string(tool->name) + ".tar");
    const std::size_t choices = tool->choices.size() - tool->alone;
    try {
      run(*tool, tool->choices[choice % choices], input, output, bytes);
    } catch (const DataError& error) {
      // findhex warns of flat and inverted tets and leaves them alone; assemble needs a mesh without.
      const bool may_refuse =
          tool == &findhex || std::string_view(error.what()).find("flat or inverted") != std::string_view::npos;
      promise(may_refuse, fmt::format("what a tool makes is taken by the next: {}", error.what()));
      throw;
    }
    choice /= choices;
    input = output;
  }
}

constexpr std::array targets{
    FuzzTarget{"tool-findhex", [](std::string_view bytes) { run_on_bundle(findhex, bytes); }, 1},
    FuzzTarget{"tool-buildgraph", [](std::string_view bytes) { run_on_bundle(buildgraph, bytes); }, 1},
    FuzzTarget{"tool-initsol", [](std::string_view bytes) { run_on_bundle(initsol, bytes); }, 1},
    FuzzTarget{"tool-lns", [](std::string_view bytes) { run_on_bundle(lns, bytes); }, 1},
    FuzzTarget{"tool-certify", [](std::string_view bytes) { run_on_bundle(certify, bytes); }, 1},
    FuzzTarget{"tool-assemble", [](std::string_view bytes) { run_on_bundle(assemble, bytes); }, 1},
    FuzzTarget{"tool-merge-parts", [](std::string_view bytes) { run_on_bundle(merge_parts, bytes); }, 1},
#ifdef HEXPIPE_FUZZES_MESH_PART
    FuzzTarget{"tool-mesh-part", [](std::string_view bytes) { run_on_bundle(mesh_part, bytes); }, 1},
#endif
#ifdef HEXPIPE_FUZZES_VIEW
    FuzzTarget{"tool-viewmesh", [](std::string_view bytes) { run_on_bundle(viewmesh, bytes); }, 1},
#endif
    FuzzTarget{"pipeline", run_pipeline},
};

}  // namespace

std::span<const FuzzTarget> tool_targets() {
  return targets;
}

}  // namespace hexpipe
