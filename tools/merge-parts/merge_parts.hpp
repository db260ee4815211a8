#pragma once
// Puts bundles together into what a single run would have made.

#include "tools/merge-parts/options.hpp"

namespace hexpipe::merge_parts {

// The first bundle tells the kind of all: pieces that assemble made, parts of a mesh, or shares (merges.hpp). Throws
// UsageError when the output cannot be written in the form that its name asks for, and DataError when the bundles do
// not belong together.
void merge_parts(const MergePartsOptions& options);

}  // namespace hexpipe::merge_parts
