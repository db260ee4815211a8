#pragma once
// What is wrong with a command line, in one line for people.

#include <CLI/CLI.hpp>
#include <string>

namespace hexpipe {

// Of an error that parsing ended with: what was not expected as it was typed, the line of a --config file, the option
// that was probably meant.
std::string explanation_of(const CLI::App& app, const CLI::ParseError& error);

}  // namespace hexpipe
