#pragma once
// Makes the history of a whole from those of its parts.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/run/stream_options.hpp"
#include "formats/pipeline/bundle.hpp"
#include "tools/merge-parts/part_reader.hpp"

namespace hexpipe::merge_parts {

// The counts of a single run.
struct MergedCounts {
  std::optional<std::int64_t> vertices, edges;  // of the graph, if it was merged
};

class MergedHistory {
 public:
  // Takes the entry at which all parts stand. Throws DataError unless the same tool made the parts, with the same
  // version and options.
  void take(PartReaders& parts);
  // Writes the entries that come before the members of this role; without a role, writes all entries.
  void write_before(std::optional<Role> role, const MergedCounts& counts, pipeline::BundleWriter& out);
  // The same for shares (--part i/k); returns which shares they are.
  std::vector<std::string> take_shares(PartReaders& parts);
  // Writes the only entry, under this name.
  void write_last(const std::string& name, const MergedCounts& counts, pipeline::BundleWriter& out);

 private:
  struct Entry {
    nlohmann::ordered_json json;
    Role made;  // the role of what the tool writes
  };
  static void write(Entry& entry, const std::string& name, const MergedCounts& counts, pipeline::BundleWriter& out);

  std::vector<Entry> entries_;  // not written yet
  int written_ = 0;
  Role latest_ = Role::mesh;
};

}  // namespace hexpipe::merge_parts
