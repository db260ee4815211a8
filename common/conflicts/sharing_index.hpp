#pragma once
// Which candidates have a tet or a quad in common. (segment_index.hpp does this for pairs of vertices.) Things are
// filed in buckets; a key of 32 bits distinguishes them within a bucket.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "common/mesh/candidates.hpp"
#include "common/run/memory.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::conflicts {

class SharingIndex {
 public:
  // The key in the high bits, the candidate in the low bits.
  using Entry = std::uint64_t;
  static CandidateIndex candidate_of(Entry entry) { return CandidateIndex(entry); }

  // things_of(candidate, visit) calls visit(bucket, key) for each thing of a candidate; each call gives the same
  // things.
  template <class ThingsOf>
  SharingIndex(std::size_t bucket_count, std::size_t candidate_count, ThingsOf&& things_of)
      : offsets_(bucket_count + 1, 0) {
    for (std::size_t i = 0; i < candidate_count; ++i)
      things_of(i, [&](std::size_t bucket, std::uint32_t) { ++offsets_[bucket + 1]; });
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    resize_in_huge_pages(entries_, static_cast<std::size_t>(offsets_.back()));
    std::vector<std::int64_t> next(offsets_.begin(), offsets_.end() - 1);
    for (std::size_t i = 0; i < candidate_count; ++i)
      things_of(i, [&](std::size_t bucket, std::uint32_t key) {
        entries_[next[bucket]++] = static_cast<Entry>(key) << 32 | static_cast<Entry>(i);
      });
    // Candidates ascend already where all keys of a bucket are the same.
    parallel_for(static_cast<std::int64_t>(bucket_count), buckets_a_block, [&](std::int64_t bucket) {
      const auto begin = entries_.begin() + offsets_[bucket], end = entries_.begin() + offsets_[bucket + 1];
      if (!std::is_sorted(begin, end)) std::sort(begin, end);
    });
  }

  // All things of the bucket, ascending by key, then by candidate.
  std::span<const Entry> in_bucket(std::size_t bucket) const {
    return {entries_.begin() + offsets_[bucket], entries_.begin() + offsets_[bucket + 1]};
  }

  // The candidates that have a thing with this key, ascending.
  std::span<const Entry> with_key(std::size_t bucket, std::uint32_t key) const {
    const auto end = entries_.begin() + offsets_[bucket + 1];
    const auto first = std::lower_bound(entries_.begin() + offsets_[bucket], end, static_cast<Entry>(key) << 32);
    auto last = first;
    while (last != end && *last >> 32 == key) ++last;
    return {first, last};
  }

 private:
  static constexpr std::int64_t buckets_a_block = 256;
  std::vector<std::int64_t> offsets_;  // buckets + 1
  std::vector<Entry> entries_;         // ascending in a bucket
};

}  // namespace hexpipe::conflicts
