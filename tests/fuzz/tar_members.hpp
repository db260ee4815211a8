#pragma once
// Mutated bytes as a tar archive whose checksums are right, so that mutations reach what lies behind them.

#include <string>
#include <string_view>

#include "common/run/random.hpp"

namespace hexpipe {

// Walks over the headers of the archive as a reader does and sets their checksums.
std::string with_right_checksums(std::string_view archive);

// A few numbers of an array in the archive are changed or exchanged, so that mutations reach what lies behind the
// checks of its form. The same bytes where there is no array.
std::string with_changed_numbers(std::string_view archive, Random& random);

}  // namespace hexpipe
