#pragma once
// Puts together what findhex or buildgraph made of one mesh or one list of candidates in shares (--part i/k).

#include <string>
#include <vector>

#include "formats/pipeline/bundle.hpp"
#include "tools/merge-parts/part_reader.hpp"

namespace hexpipe::merge_parts {

// Writes what one run without --part would have written, but for the end of the archive. Throws DataError unless the
// shares are 1/k to k/k in this order and have the same members of earlier stages.
void merge_shares(PartReaders& parts, const std::vector<std::string>& paths, pipeline::BundleWriter& out);

}  // namespace hexpipe::merge_parts
