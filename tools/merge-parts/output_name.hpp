#pragma once
// Outputs that merge-parts can write.

#include <string>
#include <string_view>
#include <vector>

namespace hexpipe::merge_parts {

// Throws UsageError where the ending names neither a bundle nor one of `others`; a name may have none.
void expect_bundle_or(const std::vector<std::string_view>& others, const std::string& path);

}  // namespace hexpipe::merge_parts
