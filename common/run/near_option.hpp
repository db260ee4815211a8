#pragma once
// Guesses which option a misspelled one was meant to be.

#include <string>
#include <string_view>
#include <vector>

namespace hexpipe {

// The name in `known` (without dashes) that `given` was probably meant to be; `given` is as typed: "--siz", "-size",
// "--min_quality=0.5". If `given` begins only one name, that is the answer. Otherwise it is the name with the fewest
// letters changed, left out, inserted or swapped with the next one, at most a third of them. Empty if there is none.
std::string near_option(std::string_view given, const std::vector<std::string>& known);

}  // namespace hexpipe
