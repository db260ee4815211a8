#pragma once
// Puts bundles of parts together.

#include <string>
#include <vector>

#include "formats/pipeline/bundle.hpp"

namespace hexpipe::merge_parts {

// Of the parts of a mesh (parts_of_mesh.hpp) or of shares (shares.hpp), whichever the first bundle is one of. All are
// read side by side, once or twice from front to back, a block at a time: arrays may be larger than the memory, which
// is for four bytes a point, tet and candidate of each part, and eight a candidate.
void merge_parts(const std::vector<std::string>& paths, pipeline::BundleWriter& out);

}  // namespace hexpipe::merge_parts
