#pragma once
// Checks the files that a command line names.

#include <CLI/CLI.hpp>

namespace hexpipe {

// Throws UsageError in three cases. An option names a file by an empty text. Two options write the same file, or both
// write standard output: one of the two outputs would be lost. A file written beside the product, such as statistics,
// would replace a file that is read. The product itself may replace one, because it gets its name after everything is
// read.
void check_named_files(const CLI::App& app);

}  // namespace hexpipe
