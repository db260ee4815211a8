#include "formats/streams/number_map.hpp"

#include <algorithm>

namespace hexpipe::formats {

NumberMap::NumberMap(const std::vector<std::int64_t>& numbers) {
  if (numbers.empty()) return;
  first_ = numbers.front();
  const auto count = static_cast<std::int64_t>(numbers.size());
  while (sequence_ < count && numbers[static_cast<std::size_t>(sequence_)] - sequence_ == first_) ++sequence_;
  if (sequence_ == count) return;

  sequence_ = 0;
  const auto [least, greatest] = std::ranges::minmax(numbers);
  first_ = least;
  const auto range = static_cast<std::uint64_t>(greatest - least);
  // A list takes 16 bytes an item, a table 4 bytes a number.
  if (range / 4 < numbers.size())
    fill_table(numbers, range);
  else
    fill_list(numbers);
}

void NumberMap::fill_table(const std::vector<std::int64_t>& numbers, std::uint64_t range) {
  table_.assign(range + 1, no_index);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::int32_t& place = table_[static_cast<std::size_t>(numbers[i] - first_)];
    if (place != no_index) repeated_ = numbers[i];
    place = static_cast<std::int32_t>(i);
  }
}

void NumberMap::fill_list(const std::vector<std::int64_t>& numbers) {
  list_.reserve(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) list_.emplace_back(numbers[i], static_cast<std::int32_t>(i));
  std::ranges::sort(list_);
  const auto twin = std::ranges::adjacent_find(list_, {}, &std::pair<std::int64_t, std::int32_t>::first);
  if (twin != list_.end()) repeated_ = twin->first;
}

std::int32_t NumberMap::find(std::int64_t number) const {
  if (number < first_) return no_index;
  const auto offset = static_cast<std::uint64_t>(number - first_);
  if (offset < static_cast<std::uint64_t>(sequence_)) return static_cast<std::int32_t>(offset);
  if (!table_.empty()) return offset < table_.size() ? table_[offset] : no_index;
  const auto found = std::ranges::lower_bound(list_, number, {}, &std::pair<std::int64_t, std::int32_t>::first);
  return found != list_.end() && found->first == number ? found->second : no_index;
}

}  // namespace hexpipe::formats
