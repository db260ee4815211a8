#pragma once
// Lists of indices, written as numbers.

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace hexpipe::testing {

template <class I>
std::vector<I> list_of(std::initializer_list<std::int32_t> numbers) {
  return {numbers.begin(), numbers.end()};
}

}  // namespace hexpipe::testing
