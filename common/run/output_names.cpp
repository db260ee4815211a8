#include "common/run/output_names.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <string>

#include "common/run/error.hpp"

namespace hexpipe {

void check_outputs_apart(const CLI::App& app, bool has_product) {
  // view reads its --fragments: no output may lie there either.
  constexpr const char* names[] = {"output", "stats", "log", "certificate", "fragments", "reduced-candidates", "png"};
  std::map<std::string, std::string> option_of;  // by the file
  if (has_product && app.count("--output") == 0) option_of.emplace("-", "output");
  for (const std::string name : names) {
    const CLI::Option* const option = app.get_option_no_throw("--" + name);
    if (option == nullptr || option->count() == 0) continue;
    const std::string& file = option->results().front();
    if (file.starts_with("/dev/")) continue;
    const auto [other, is_first] = option_of.emplace(std::filesystem::path(file).lexically_normal().string(), name);
    if (!is_first)
      throw UsageError(fmt::format("expected different files for --{} and --{}, found {} for both", other->second, name,
                                   file == "-" ? "standard output" : file));
  }
}

}  // namespace hexpipe
