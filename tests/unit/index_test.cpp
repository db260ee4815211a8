#include "common/mesh/index.hpp"

#include <gtest/gtest.h>

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "common/mesh/candidates.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {
namespace {

template <class A, class B>
concept AreComparable = requires(A a, B b) {
  a == b;
}
|| requires(A a, B b) {
  a != b;
}
|| requires(A a, B b) {
  a < b;
};
template <class Table, class I>
concept IsIndexedBy = requires(Table table, I i) {
  table[i];
};
template <class List, class Item>
concept Takes = requires(List list, Item item) {
  list.push_back(item);
};

// An index costs what a number costs.
static_assert(sizeof(TetIndex) == sizeof(std::int32_t) && std::is_trivially_copyable_v<TetIndex>);

// Only no_index becomes an index of its own accord.
static_assert(std::convertible_to<NoIndex, TetIndex> && std::convertible_to<NoIndex, std::int32_t>);
static_assert(!std::convertible_to<std::int32_t, TetIndex> && !std::convertible_to<std::size_t, TetIndex>);
static_assert(!std::convertible_to<CandidateIndex, TetIndex> && !std::assignable_from<TetIndex&, CandidateIndex>);
static_assert(!Takes<std::vector<TetIndex>, CandidateIndex> && !Takes<std::vector<TetIndex>, std::int32_t>);
static_assert(Takes<std::vector<TetIndex>, TetIndex> && Takes<std::vector<TetIndex>, NoIndex>);
static_assert(!std::convertible_to<std::vector<TetIndex>, std::vector<CandidateIndex>>);

// Numbers may be made to indices aloud, indices of another kind not even so.
static_assert(std::constructible_from<TetIndex, std::int32_t> && std::constructible_from<TetIndex, std::size_t>);
static_assert(!std::constructible_from<TetIndex, CandidateIndex>);

// An index is read as a number, but is neither true nor false.
static_assert(std::convertible_to<TetIndex, std::int32_t> && IsIndexedBy<std::vector<int>, TetIndex>);
static_assert(!std::constructible_from<bool, TetIndex>);

static_assert(AreComparable<TetIndex, TetIndex> && AreComparable<TetIndex, int> && AreComparable<TetIndex, NoIndex>);
static_assert(!AreComparable<TetIndex, CandidateIndex>);

// Nothing but its own kind indexes a typed table.
static_assert(IsIndexedBy<IndexedVector<TetIndex, int>, TetIndex>);
static_assert(!IsIndexedBy<IndexedVector<TetIndex, int>, CandidateIndex>);
static_assert(!IsIndexedBy<IndexedVector<TetIndex, int>, std::int32_t>);
static_assert(!IsIndexedBy<const IndexedVector<TetIndex, int>, std::size_t>);

TEST(Index, IsNoneUntilItIsGiven) {
  EXPECT_TRUE(TetIndex() == no_index);
  EXPECT_TRUE(TetIndex(0) != no_index);
  EXPECT_EQ(std::vector<TetIndex>(2), (std::vector<TetIndex>{no_index, no_index}));
}

TEST(Index, CountsFromTheFirstToTheLast) {
  std::vector<std::int32_t> all, some;
  for (const auto t : indices<TetIndex>(3)) all.push_back(t);
  for (const auto t : indices<TetIndex>(2, 5)) some.push_back(t);
  EXPECT_EQ(all, (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(some, (std::vector<std::int32_t>{2, 3, 4}));
  for (const auto t : indices<TetIndex>(0)) FAIL() << t;
}

TEST(Index, NumbersOfAListWithoutKindsAreReadAsIndices) {
  const std::vector<std::int32_t> numbers{4, 7};
  std::vector<TetIndex> tets;
  for (const auto t : as_indices<TetIndex>(numbers)) tets.push_back(t);
  EXPECT_EQ(tets, std::vector<TetIndex>(numbers.begin(), numbers.end()));
}

TEST(Index, ATypedTableIsAVector) {
  IndexedVector<TetIndex, int> table{5, 6};
  table[TetIndex(1)] = 8;
  EXPECT_EQ(table[TetIndex(1)], 8);
  EXPECT_EQ(table, (IndexedVector<TetIndex, int>(std::vector<int>{5, 8})));
}

}  // namespace
}  // namespace hexpipe
