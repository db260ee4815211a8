#pragma once
// What the ending of an output's name asks for.

#include <string>
#include <string_view>
#include <vector>

namespace hexpipe {

// Without its dot; empty where there is none.
std::string ending_of(const std::string& path);

// Throws UsageError where the ending names neither a bundle nor one of `others`; a name may have none.
void expect_bundle_or(const std::vector<std::string_view>& others, const std::string& path);

}  // namespace hexpipe
