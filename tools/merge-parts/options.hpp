#pragma once
// The command line of merge-parts as values.

#include <string>
#include <vector>

namespace hexpipe::merge_parts {

struct MergePartsOptions {
  std::vector<std::string> paths;  // bundles
  std::string output;              // a file; empty or "-": standard output
  bool compress = false;           // write the bundle with zstd
};

}  // namespace hexpipe::merge_parts
