#include "tools/merge-parts/merge_parts.hpp"

#include "common/run/open_files.hpp"
#include "formats/pipeline/members.hpp"
#include "tools/merge-parts/part_reader.hpp"
#include "tools/merge-parts/parts_of_mesh.hpp"
#include "tools/merge-parts/shares.hpp"

namespace hexpipe::merge_parts {

void merge_parts(const std::vector<std::string>& paths, pipeline::BundleWriter& out) {
  allow_many_open_files();
  PartReaders parts;
  parts.reserve(paths.size());
  for (const std::string& path : paths) parts.emplace_back(path);
  if (parts.front().at_member() && pipeline::is_part_title(parts.front().name()))
    merge_parts_of_mesh(parts, out);
  else
    merge_shares(parts, paths, out);
}

}  // namespace hexpipe::merge_parts
