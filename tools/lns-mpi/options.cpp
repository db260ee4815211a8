#include "tools/lns-mpi/options.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <utility>

#include "common/run/error.hpp"

namespace hexpipe::lns_mpi {
namespace {

// Each part gives a bundle of its own name.
void expect_different_names(const std::vector<std::string>& parts) {
  std::map<std::string, std::string> part_by_name;
  for (const std::string& part : parts) {
    const auto [other, is_new] = part_by_name.emplace(std::filesystem::path(part).filename(), part);
    if (!is_new)
      throw UsageError(fmt::format("expected parts of different names, found {} and {}", other->second, part));
  }
}

void check_parts(const LnsMpiOptions& options, const RunContext& context) {
  if (context.streams.operand || !context.streams.files.empty())
    throw UsageError("expected --parts or a graph, found both");
  const std::pair<const char*, bool> for_whole_graphs[] = {{"--blocks", options.blocks > 0},
                                                           {"--certificate", !options.certificate.empty()},
                                                           {"--fragments", !options.fragments.empty()}};
  for (const auto& [name, is_given] : for_whole_graphs)
    if (is_given) throw UsageError(fmt::format("{} needs a graph that is not in parts", name));
  if (writes_standard_output(context)) throw UsageError("--parts needs a directory to write to: -o DIR");
  expect_different_names(options.parts);
}

}  // namespace

bool writes_standard_output(const RunContext& context) {
  return context.streams.output.empty() || context.streams.output == "-";
}

void check(const LnsMpiOptions& options, bool round_is_given, const RunContext& context) {
  if (!options.parts.empty()) check_parts(options, context);
  if (round_is_given && !context.common.iterations) throw UsageError("--round does nothing without --iterations");
  if (!options.certificate.empty() && options.passes == 0)
    throw UsageError("--certificate needs a bound, and --prove 0 proves none");
}

}  // namespace hexpipe::lns_mpi
