#pragma once
// Files that a command line names to be written.

#include <CLI/CLI.hpp>

namespace hexpipe {

// Throws UsageError where two options name the same file to write, for what one of them writes would be lost, or
// standard output. `has_product`: without -o, a product goes there. What lies in /dev may be named twice.
void check_outputs_apart(const CLI::App& app, bool has_product);

}  // namespace hexpipe
