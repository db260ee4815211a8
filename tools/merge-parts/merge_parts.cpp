
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "common/run/error.hpp"
#include "common/run/open_files.hpp"
#include "common/run/progress.hpp"
#include "formats/meshes/mesh_files.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/members.hpp"
#include "formats/streams/output.hpp"
#include "tools/merge-parts/merges.hpp"

namespace hexpipe::merge_parts {
namespace {

// Throws UsageError where the ending names neither a bundle nor one of `others`; a name may have no ending.
void expect_bundle_or(std::vector<std::string_view> others, const std::string& path) {
  const std::string_view ending = pipeline::ending_of(path);
  if (ending.empty() || pipeline::is_bundle_format(ending)) return;
  others.insert(others.end(), {pipeline::bundle_format, pipeline::compressed_bundle_format});
  if (std::ranges::find(others, ending) == others.end())
    throw UsageError(fmt::format("expected an output as {}, found '{}'", fmt::join(others, ", "), path));
}

// In all files; what is read from a pipe is not known.
std::int64_t bytes_of(const std::vector<std::string>& paths) {
  std::int64_t bytes = 0;
  for (const std::string& path : paths) {
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error))
      bytes += static_cast<std::int64_t>(std::filesystem::file_size(path, error));
  }
  return bytes;
}

// Arrays may be larger than the memory: the bundles are read side by side, once or twice from front to back, a block at
// a time. That takes four bytes for each point, tet and candidate of each part, and eight more for each candidate.
void merge_side_by_side(const std::vector<std::string>& paths, pipeline::BundleWriter& out) {
  allow_many_open_files();
  PartReaders parts;
  parts.reserve(paths.size());
  Step step("putting parts together");
  step.expect(bytes_of(paths));
  for (const std::string& path : paths) parts.emplace_back(path).show_in(step);
  if (parts.front().at_member() && pipeline::is_part_title(parts.front().name()))
    merge_parts_of_mesh(parts, out);
  else
    merge_shares(parts, paths, out);
}

}  // namespace

void merge_parts(const MergePartsOptions& options) {
  if (is_piece(options.paths.front())) {
    std::vector<std::string_view> formats = formats::mesh_format_names();
    formats.emplace_back("pvtu");
    expect_bundle_or(formats, options.output);
    merge_pieces(options.paths, options.output, options.compress);
    return;
  }
  expect_bundle_or({}, options.output);
  formats::Output output(options.output);
  pipeline::BundleWriter writer(
      output, options.compress || pipeline::ending_of(options.output) == pipeline::compressed_bundle_format);
  merge_side_by_side(options.paths, writer);
  writer.close();
  output.commit();
}

}  // namespace hexpipe::merge_parts
