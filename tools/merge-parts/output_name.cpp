#include "tools/merge-parts/output_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/run/error.hpp"
#include "formats/pipeline/output_format.hpp"

namespace hexpipe::merge_parts {

void expect_bundle_or(const std::vector<std::string_view>& others, const std::string& path) {
  const std::string_view ending = pipeline::ending_of(path);
  if (ending.empty() || pipeline::is_bundle_format(ending)) return;
  std::vector<std::string_view> known = others;
  known.insert(known.end(), {pipeline::bundle_format, pipeline::compressed_bundle_format});
  if (std::ranges::find(known, ending) == known.end())
    throw UsageError(fmt::format("expected an output as {}, found '{}'", fmt::join(known, ", "), path));
}

}  // namespace hexpipe::merge_parts
