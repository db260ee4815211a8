#pragma once
// Mutated bytes as a tar archive whose checksums are right, so that mutations reach what lies behind them.

#include <string>
#include <string_view>

namespace hexpipe {

// Walks over the headers of the archive as a reader does and sets their checksums.
std::string with_right_checksums(std::string_view archive);

}  // namespace hexpipe
