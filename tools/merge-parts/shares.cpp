#include "tools/merge-parts/merges.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <system_error>
#include <utility>

#include "common/mesh/candidates.hpp"
#include "common/run/error.hpp"
#include "tools/merge-parts/history.hpp"
#include "tools/merge-parts/interleaving.hpp"

namespace hexpipe::merge_parts {
namespace {

// The role that is in shares: its members are the last ones before the last history entry.
struct Shared {
  std::string folder;      // "candidates/" or "graph/"
  std::string last_entry;  // of the history
  std::vector<std::vector<std::uint8_t>> kinds;
};

// Reads all bundles once before they are merged: the last members decide which role is in shares.
Shared look_through(const std::vector<std::string>& paths) {
  Shared shared;
  for (const std::string& path : paths) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(path, unknown))
      throw DataError::at(path, "expected a file, because shares and pieces are read twice, found a pipe or a device");
    PartReader part(path);
    std::string last;
    std::vector<std::uint8_t> kinds;
    for (; part.at_member(); part.next()) {
      last = part.name();
      if (last == "candidates/kind.npy") kinds = part.bundle().read_array<std::uint8_t>();
    }
    if (shared.kinds.empty()) shared.last_entry = last;
    shared.kinds.push_back(std::move(kinds));
  }
  const auto ends_with = [&](const char* ending) { return shared.last_entry.ends_with(ending); };
  if (!ends_with("-findhex.json") && !ends_with("-buildgraph.json"))
    throw DataError::at(paths.front(),
                        "expected a bundle that findhex or buildgraph wrote last with --part, found another");
  shared.folder = ends_with("-findhex.json") ? "candidates/" : "graph/";
  return shared;
}

// Each kind in the order of the shares.
Interleaving order_by_kinds(const std::vector<std::vector<std::uint8_t>>& kinds) {
  Interleaving order;
  std::vector<std::size_t> at(kinds.size(), 0);
  for (const auto& of_part : kinds) order.gives.emplace_back(of_part.size(), true);
  for (const CellKind kind : {CellKind::hex, CellKind::prism, CellKind::pyramid})
    for (std::size_t p = 0; p < kinds.size(); ++p)
      for (; at[p] < kinds[p].size() && kinds[p][at[p]] == static_cast<std::uint8_t>(kind); ++at[p])
        order.part_of_row.push_back(static_cast<std::uint16_t>(p));
  return order;
}

class CandidateShares {
 public:
  CandidateShares(PartReaders& parts, const Shared& shared, pipeline::BundleWriter& out)
      : parts_(parts), order_(order_by_kinds(shared.kinds)), out_(out) {}

  bool merge_member(const std::string& name) {
    if (name == "candidates/vertices.npy")
      merge_rows<std::array<Vertex, 8>>(parts_, order_, out_, unchanged);
    else if (name == "candidates/kind.npy")
      merge_rows<std::uint8_t>(parts_, order_, out_, unchanged);
    else if (name == "candidates/quality.npy" || name == "candidates/volume.npy")
      merge_rows<double>(parts_, order_, out_, unchanged);
    else if (name == "candidates/tet_offsets.npy" || name == "candidates/boundary_tet_offsets.npy")
      lengths_ = merge_offsets(parts_, order_, out_);
    else if (name == "candidates/tets.npy" || name == "candidates/boundary_tets.npy")
      merge_items(parts_, order_, lengths_, out_, unchanged);
    else
      return false;
    return true;
  }

 private:
  PartReaders& parts_;
  Interleaving order_;
  pipeline::BundleWriter& out_;
  ListLengths lengths_;
};

// Each conflict is in one share, at both ends, and later shares have the higher neighbours: rows are joined.
class GraphShares {
 public:
  GraphShares(PartReaders& parts, pipeline::BundleWriter& out) : parts_(parts), out_(out) {}

  bool merge_member(const std::string& name) {
    if (name == "graph/offsets.npy")
      merge_offsets();
    else if (name == "graph/neighbours.npy")
      merge_neighbours();
    else if (name == "graph/weights.npy")
      copy_common(parts_, out_);
    else
      return false;
    return true;
  }
  MergedCounts counts() const { return {vertices_, ends_ / 2}; }

 private:
  void merge_offsets() {
    for (PartReader& part : parts_) {
      const std::vector<std::int64_t> offsets = part.bundle().read_array<std::int64_t>();
      if (lengths_.empty()) vertices_ = std::max<std::int64_t>(0, static_cast<std::int64_t>(offsets.size()) - 1);
      if (static_cast<std::int64_t>(offsets.size()) != vertices_ + 1)
        throw DataError::at(part.bundle().where(), "expected {} ends of lists, found {}", vertices_ + 1,
                            offsets.size());
      auto& lengths = lengths_.emplace_back();
      for (std::int64_t v = 0; v < vertices_; ++v) lengths.push_back(list_length(part, offsets[v], offsets[v + 1]));
    }
    RowWriter<std::int64_t> writer(out_, parts_.front().name(), vertices_ + 1);
    writer.add(0);
    for (std::int64_t v = 0; v < vertices_; ++v) {
      for (const auto& lengths : lengths_) ends_ += lengths[v];
      writer.add(ends_);
    }
    writer.flush();
  }

  void merge_neighbours() {
    check_ends_are_there(parts_, lengths_);
    std::vector<RowReader<std::int32_t>> readers;
    readers.reserve(parts_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p)
      readers.emplace_back(parts_[p], std::accumulate(lengths_[p].begin(), lengths_[p].end(), std::uint64_t{0}));
    RowWriter<std::int32_t> writer(out_, parts_.front().name(), ends_);
    for (std::int64_t v = 0; v < vertices_; ++v)
      for (std::size_t p = 0; p < parts_.size(); ++p)
        for (std::int32_t i = 0; i < lengths_[p][v]; ++i) writer.add(readers[p].next());
    writer.flush();
  }

  PartReaders& parts_;
  pipeline::BundleWriter& out_;
  std::int64_t vertices_ = 0, ends_ = 0;
  ListLengths lengths_;
};

void check_shares(const std::vector<std::string>& shares) {
  std::vector<std::string> wanted;
  wanted.reserve(shares.size());
  for (std::size_t i = 1; i <= shares.size(); ++i) wanted.push_back(fmt::format("{}/{}", i, shares.size()));
  if (shares != wanted)
    throw DataError(fmt::format("expected the parts {} to {} in order, found {}", wanted.front(), wanted.back(),
                                fmt::join(shares, ", ")));
}

}  // namespace

void merge_shares(PartReaders& parts, const std::vector<std::string>& paths, pipeline::BundleWriter& out) {
  const Shared shared = look_through(paths);
  const bool of_graph = shared.folder == "graph/";
  CandidateShares candidates(parts, shared, out);
  GraphShares graph(parts, out);
  MergedHistory history;
  for (; !common_member(parts).empty(); next(parts)) {
    const std::string name = common_member(parts);
    if (name == shared.last_entry)
      check_shares(history.take_shares(parts));
    else if (!name.starts_with(shared.folder))
      copy_common(parts, out);
    else if (!(of_graph ? graph.merge_member(name) : candidates.merge_member(name)))
      throw DataError::at(parts.front().bundle().where(), "expected members of {}, found one that cannot be merged",
                          shared.folder);
  }
  history.write_last(shared.last_entry, of_graph ? graph.counts() : MergedCounts(), out);
}

}  // namespace hexpipe::merge_parts
