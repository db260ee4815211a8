#pragma once
// What a misspelled option was probably meant to be.

#include <string>
#include <string_view>
#include <vector>

namespace hexpipe {

// Of the names in `known` (without dashes) the one that `given` (as typed: "--siz", "-size", "--min_quality=0.5")
// begins, if it is the only one, else the one with the fewest letters changed, left out, put in or exchanged with the
// next, at most a third of them. Empty if there is none.
std::string near_option(std::string_view given, const std::vector<std::string>& known);

}  // namespace hexpipe
