#include "tools/merge-parts/part_numbers.hpp"

#include <limits>
#include <queue>
#include <utility>

#include "common/run/error.hpp"

namespace hexpipe::merge_parts {

Numbers read_numbers(PartReaders& parts, std::int64_t count) {
  if (count > std::numeric_limits<std::int32_t>::max())
    throw DataError::at(parts.front().bundle().where(),
                        "expected numbers below 2^31 for a bundle of the whole, found {}", count);
  Numbers numbers(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::int64_t last = -1;
    for (const std::int64_t number : parts[p].bundle().read_array<std::int64_t>()) {
      if (number <= last || number >= count)
        throw DataError::at(parts[p].bundle().where(), "expected ascending numbers below {}, found {} after {}", count,
                            number, last);
      numbers[p].push_back(static_cast<std::int32_t>(number));
      last = number;
    }
  }
  return numbers;
}

CandidateOrder order_by_keys(const std::vector<CandidateKeys>& keys, const std::vector<std::int32_t>& titles,
                             const PartReaders& parts) {
  using Head = std::pair<std::uint64_t, std::size_t>;  // key, part
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
  CandidateOrder order;
  order.numbers.resize(keys.size());
  std::vector<std::size_t> at(keys.size(), 0);
  for (std::size_t p = 0; p < keys.size(); ++p) {
    validate(keys[p], keys[p].key.size(), parts[p].bundle_name().c_str());
    order.own.gives.emplace_back(keys[p].key.size());
    order.numbers[p].resize(keys[p].key.size());
    if (!keys[p].key.empty()) heads.emplace(keys[p].key.front(), p);
  }
  while (!heads.empty()) {
    const std::uint64_t key = heads.top().first;
    const auto number = static_cast<std::int32_t>(order.own.size());
    bool has_owner = false;
    std::size_t some_part = 0;
    while (!heads.empty() && heads.top().first == key) {
      const std::size_t p = some_part = heads.top().second;
      heads.pop();
      const std::size_t i = at[p]++;
      order.numbers[p][i] = number;
      const bool is_own = keys[p].part[i] == titles[p];
      if (is_own && std::exchange(has_owner, true))
        throw DataError::at(parts[p].bundle_name(), "expected candidates of one part each, found one of two: key {}",
                            key);
      if (is_own) order.own.part_of_row.push_back(static_cast<std::uint16_t>(p));
      order.own.gives[p][i] = is_own;
      if (at[p] < keys[p].key.size()) heads.emplace(keys[p].key[at[p]], p);
    }
    if (!has_owner)
      throw DataError::at(parts[some_part].bundle_name(),
                          "expected candidates of parts that are there, found one that none owns: key {}", key);
    if (order.own.size() > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
      throw DataError::at(parts[some_part].bundle_name(), "expected fewer than 2^31 candidates in all, found more");
  }
  return order;
}

}  // namespace hexpipe::merge_parts
