#include "tools/merge-parts/output_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "common/run/error.hpp"

namespace hexpipe {

std::string ending_of(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending.empty() ? ending : ending.substr(1);
}

void expect_bundle_or(const std::vector<std::string_view>& others, const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending.empty() || ending == "tar" || path.ends_with(".tar.zst")) return;
  std::vector<std::string_view> known = others;
  known.insert(known.end(), {"tar", "tar.zst"});
  if (std::ranges::find(known, ending) == known.end())
    throw UsageError(fmt::format("expected an output as {}, found '{}'", fmt::join(known, ", "), path));
}

}  // namespace hexpipe
