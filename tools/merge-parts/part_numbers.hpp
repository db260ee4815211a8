#pragma once
// Which number what a part has is in the whole.

#include <cstdint>
#include <vector>

#include "common/mesh/mesh_part.hpp"
#include "tools/merge-parts/interleaving.hpp"
#include "tools/merge-parts/part_reader.hpp"

namespace hexpipe::merge_parts {

using Numbers = std::vector<std::vector<std::int32_t>>;  // by part and place in the part

// Of the member at which all parts stand, ascending and below `count`.
Numbers read_numbers(PartReaders& parts, std::int64_t count);

// By keys: the candidates that are a part's own, and the numbers of all in their order.
struct CandidateOrder {
  Interleaving own;
  Numbers numbers;
};

// `titles`: which part each one is. Throws DataError when keys do not
// ascend, two parts own a candidate, or none does.
CandidateOrder order_by_keys(const std::vector<CandidateKeys>& keys, const std::vector<std::int32_t>& titles,
                             const PartReaders& parts);

}  // namespace hexpipe::merge_parts
