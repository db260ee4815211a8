#pragma once
// Finds the numbers in the whole mesh of the items that a part has.

#include <cstdint>
#include <vector>

#include "common/mesh/mesh_part.hpp"
#include "tools/merge-parts/interleaving.hpp"
#include "tools/merge-parts/part_reader.hpp"

namespace hexpipe::merge_parts {

using Numbers = std::vector<std::vector<std::int32_t>>;  // by part and place in the part

// Reads the member at which all parts stand; numbers ascend and are below `count`.
Numbers read_numbers(PartReaders& parts, std::int64_t count);

// The candidates that are a part's own, in the order of keys, and the numbers of all candidates in that order.
struct CandidateOrder {
  Interleaving own;
  Numbers numbers;
};

// `titles`: the number of each part. Throws DataError when keys do not ascend, two parts own a candidate, or none does.
CandidateOrder order_by_keys(const std::vector<CandidateKeys>& keys, const std::vector<std::int32_t>& titles,
                             const PartReaders& parts);

}  // namespace hexpipe::merge_parts
