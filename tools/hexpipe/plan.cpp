#include "tools/hexpipe/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "common/run/error.hpp"

namespace hexpipe::front_door {
namespace {

// The stages in order, each with the name of what it makes: --keep writes FOLDER/NAME.tar, --from takes a NAME. The
// first and the last run for CAD only.
struct Stage {
  const char* tool;
  const char* product;
};
constexpr std::array stages{Stage{"tessellate", "surface"}, Stage{"tetmesh", "mesh"},
                            Stage{"findhex", "candidates"}, Stage{"buildgraph", "conflicts"},
                            Stage{"initsol", "solution"},   Stage{"lns", "choice"},
                            Stage{"assemble", "result"},    Stage{"fitcad", "fitted result"}};
constexpr std::size_t tetmesh_stage = 1, findhex_stage = 2, search_stage = 5, fitcad_stage = 7;

bool has_ending(const std::string& path, std::initializer_list<std::string_view> endings) {
  std::string lower = path;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::any_of(endings, [&](std::string_view ending) { return lower.ends_with(ending); });
}

bool is_cad(const std::string& path) {
  return has_ending(path, {".step", ".stp", ".stpz", ".iges", ".igs", ".brep", ".brp", ".fcstd"});
}

std::string kept_file(const PipeOptions& options, std::string_view product) {
  return fmt::format("{}/{}.tar", *options.keep, product);
}

// The first stage that runs.
std::size_t first_stage(const PipeOptions& options) {
  if (options.from) {
    const auto found = std::ranges::find(stages, std::string_view(*options.from), &Stage::product);
    if (found == stages.end() || found + 1 == stages.end())
      throw UsageError(
          fmt::format("expected --from surface, mesh, candidates, conflicts, solution, choice or result, found '{}'",
                      *options.from));
    return static_cast<std::size_t>(found - stages.begin()) + 1;
  }
  if (options.mesh) return findhex_stage;
  return is_cad(options.input) ? 0 : tetmesh_stage;
}

// The last stage that runs. What an earlier run kept began with CAD if it has a surface.
std::size_t last_stage(const PipeOptions& options) {
  const bool from_cad = options.from ? std::filesystem::exists(kept_file(options, "surface")) : is_cad(options.input);
  if (!from_cad && options.from == stages[fitcad_stage - 1].product)
    throw UsageError("--from result goes with CAD, whose faces the result is moved onto; the result is the last stage");
  return from_cad ? fitcad_stage : fitcad_stage - 1;
}

// Seconds for the searches, and whether to search for points.
std::vector<std::string> words_of_effort(std::string_view tool, Effort effort) {
  if (effort == Effort::quick && tool == "initsol") return {"--time-limit", "1"};
  if (effort == Effort::quick && tool == "lns") return {"--time-limit", "3"};
  if (effort == Effort::thorough && tool == "tetmesh") return {"--improve", "100000", "--time-limit", "60"};
  if (effort == Effort::thorough && tool == "lns") return {"--time-limit", "300"};
  return {};
}

std::vector<std::string> words_of(const std::string& tool, const PipeOptions& options) {
  std::vector<std::string> words;
  const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
  if (tool == "tetmesh" && options.size) add({"--size", *options.size});
  if (options.threads) add({"--threads", std::to_string(*options.threads)});
  const bool is_random = tool == "tetmesh" || tool == "initsol" || tool == "lns";
  if (options.seed && is_random) add({"--seed", std::to_string(*options.seed)});
  const auto more = options.stage_options.find(tool);
  const std::vector<std::string> own =
      more == options.stage_options.end() ? std::vector<std::string>{} : shell_words(more->second, "--" + tool);
  // The user's options for a stage replace those of the effort.
  const std::vector<std::string> of_effort = words_of_effort(tool, options.effort);
  for (std::size_t i = 0; i < of_effort.size(); i += 2)
    if (std::ranges::find(own, of_effort[i]) == own.end()) add({of_effort[i], of_effort[i + 1]});
  words.insert(words.end(), own.begin(), own.end());
  return words;
}

void check(const PipeOptions& options) {
  const int starts = (options.input.empty() ? 0 : 1) + (options.mesh ? 1 : 0) + (options.from ? 1 : 0);
  if (starts == 0) throw UsageError("nothing to mesh: name a surface or a CAD file, or tets by --mesh");
  if (starts > 1) throw UsageError("expected one of a surface, --mesh and --from, found several");
  if (options.from && !options.keep) throw UsageError("--from needs --keep FOLDER, where an earlier run left it");
  if (options.output.empty()) throw UsageError("expected -o FILE for the result");
  if (options.size && first_stage(options) > tetmesh_stage)
    throw UsageError("--size does nothing behind tetmesh, which has placed the points already");
  for (const auto& [tool, text] : options.stage_options) {
    const auto stage = std::ranges::find(stages, std::string_view(tool), &Stage::tool);
    const auto number = static_cast<std::size_t>(stage - stages.begin());
    if (stage == stages.end()) continue;
    if (number < first_stage(options))
      throw UsageError(fmt::format("--{} does nothing: the pipe starts behind it", tool));
    if (number > last_stage(options)) throw UsageError(fmt::format("--{} does nothing without CAD", tool));
  }
}

// viewmesh reads these formats; for any other format it gets the bundle.
bool is_shown_from_file(const std::string& path) {
  return has_ending(path, {".vtu", ".vtk", ".msh", ".mesh", ".tar", ".tar.zst"});
}

std::string quoted(const std::string& word) {
  const bool is_plain = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) || std::string_view("_-+=./,:@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain) return word;
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string line_of(const Command& command) {
  std::string line = command.tool;
  for (const std::string& word : command.words) line += ' ' + quoted(word);
  if (command.kept_in) line += " | tee " + quoted(*command.kept_in);
  return line;
}

}  // namespace

Plan plan_of(const PipeOptions& options) {
  check(options);
  Plan plan;
  plan.folder = options.keep;
  const std::size_t last = last_stage(options);
  for (std::size_t s = first_stage(options); s <= last; ++s) {
    const std::string tool = stages[s].tool;
    Command command{tool, words_of(tool, options), std::nullopt};
    if (plan.pipe.empty()) {
      if (options.from)
        command.words.insert(command.words.begin(), kept_file(options, *options.from));
      else if (options.mesh)
        command.words.insert(command.words.begin(), {"--mesh", *options.mesh});
      else
        command.words.insert(command.words.begin(), options.input);
    }
    if (s == last) {
      // The last stage writes for the solver; what the others write are bundles.
      if (options.solver) command.words.insert(command.words.end(), {"--solver", *options.solver});
      command.words.insert(command.words.end(), {"-o", options.output});
    } else if (options.keep) {
      command.kept_in = kept_file(options, stages[s].product);
    } else if (s == search_stage) {
      // What is kept may go to certify; assemble reads no conflicts, of which there is half a kB for each tet.
      command.words.emplace_back("--slim");
    }
    plan.pipe.push_back(std::move(command));
  }
  if (!options.page && !options.picture) return plan;
  if (!is_shown_from_file(options.output))
    throw UsageError(
        fmt::format("--page and --png show a .vtu, .vtk, .msh, .mesh or .tar, found '{}'; "
                    "keep the choice by --keep FOLDER and go on from it with --from choice",
                    options.output));
  Command view{"viewmesh", {options.output}, std::nullopt};
  if (options.page) view.words.insert(view.words.end(), {"-o", *options.page});
  if (options.picture) view.words.insert(view.words.end(), {"--png", *options.picture});
  const std::vector<std::string> more = words_of("viewmesh", options);
  view.words.insert(view.words.end(), more.begin(), more.end());
  plan.behind.push_back(std::move(view));
  return plan;
}

std::string as_shell(const Plan& plan) {
  std::string text = plan.folder ? fmt::format("mkdir -p {} &&\n", quoted(*plan.folder)) : std::string();
  for (std::size_t i = 0; i < plan.pipe.size(); ++i) text += (i == 0 ? "" : " |\n  ") + line_of(plan.pipe[i]);
  for (const Command& command : plan.behind) text += " &&\n" + line_of(command);
  return text + '\n';
}

std::vector<std::string> shell_words(const std::string& text, const std::string& option) {
  std::vector<std::string> words;
  std::string word;
  bool in_word = false;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      const bool escapes =
          quote == '"' && c == '\\' && i + 1 < text.size() && (text[i + 1] == '"' || text[i + 1] == '\\');
      if (c == quote)
        quote = 0;
      else
        word += escapes ? text[++i] : c;
    } else if (c == '\'' || c == '"') {
      quote = c;
      in_word = true;
    } else if (std::isspace(static_cast<unsigned char>(c))) {
      if (in_word) words.push_back(std::move(word));
      word.clear();
      in_word = false;
    } else {
      word += c == '\\' && i + 1 < text.size() ? text[++i] : c;
      in_word = true;
    }
  }
  if (quote != 0) throw UsageError(fmt::format("{}: expected a {} at the end of '{}'", option, quote, text));
  if (in_word) words.push_back(std::move(word));
  return words;
}

}  // namespace hexpipe::front_door
