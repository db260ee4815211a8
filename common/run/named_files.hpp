#pragma once
// Files that a command line names.

#include <CLI/CLI.hpp>

namespace hexpipe {

// Throws UsageError where an option names a file by an empty text; where two options name the same file to write, or
// standard output, for what one of them writes would be lost; and where what is written beside the product, such as
// statistics, would replace a file that is read. A product may: it has its name when all is read.
void check_named_files(const CLI::App& app);

}  // namespace hexpipe
