#pragma once
// Puts together the bundles of the parts of a mesh: the mesh, and its candidates, graph and solution where they are
// there.

#include "formats/pipeline/bundle.hpp"
#include "tools/merge-parts/part_reader.hpp"

namespace hexpipe::merge_parts {

// Writes what a single run would have written, but for the end of the archive. The parts may come in any order. Throws
// DataError when one is missing, is of another mesh or another number of parts, comes twice, or was made with other
// options.
void merge_parts_of_mesh(PartReaders& parts, pipeline::BundleWriter& out);

}  // namespace hexpipe::merge_parts
