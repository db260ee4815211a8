#pragma once
// Explains in one line what is wrong with a command line.

#include <CLI/CLI.hpp>
#include <string>

namespace hexpipe {

// The explanation of a parse error: the arguments as they were typed, the line of a --config file, and the option that
// was probably meant.
std::string explanation_of(const CLI::App& app, const CLI::ParseError& error);

}  // namespace hexpipe
