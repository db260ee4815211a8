#pragma once
// Numbers of things in a list, from 0. Each kind of thing has its own type of number, so that the compiler does not
// take the number of one thing for that of another.

#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace hexpipe {

// Stands for no vertex, tet, cell or candidate where an index of any kind is expected.
struct NoIndex {
  constexpr operator std::int32_t() const { return -1; }
};
inline constexpr NoIndex no_index{};

// Kind only tells one type from the other. An index is a number where it is read: it indexes arrays, is compared with
// numbers and computed with. No number and no index of another kind becomes one unless the code says so.
template <class Kind>
class Index {
 public:
  constexpr Index() = default;  // none
  constexpr Index(NoIndex none) : number_(none) {}
  template <std::integral Number>
  constexpr explicit Index(Number number) : number_(static_cast<std::int32_t>(number)) {}

  constexpr operator std::int32_t() const { return number_; }
  explicit operator bool() const = delete;  // 0 is a thing, too

  friend constexpr std::int32_t format_as(Index i) { return i; }  // for fmt

  constexpr Index& operator++() { return ++number_, *this; }
  constexpr Index operator++(int) { return Index(number_++); }

 private:
  std::int32_t number_ = no_index;
};

// Indices of one kind are compared as numbers, those of two kinds are not compared.
template <class A, class B>
requires(!std::same_as<A, B>) bool operator==(Index<A>, Index<B>) = delete;
template <class A, class B>
requires(!std::same_as<A, B>) std::strong_ordering operator<=>(Index<A>, Index<B>) = delete;

// Things one after the other, for a loop: for (const auto t : indices<TetIndex>(mesh.tets.size())).
template <class I>
class Indices {
 public:
  class Iterator {
   public:
    constexpr explicit Iterator(I at) : at_(at) {}
    constexpr I operator*() const { return at_; }
    constexpr Iterator& operator++() { return ++at_, *this; }
    constexpr bool operator==(const Iterator&) const = default;

   private:
    I at_;
  };

  constexpr Indices(std::size_t begin, std::size_t end) : begin_(begin), end_(end) {}
  constexpr Iterator begin() const { return Iterator(begin_); }
  constexpr Iterator end() const { return Iterator(end_); }

 private:
  I begin_, end_;
};
template <class I>
constexpr Indices<I> indices(std::size_t begin, std::size_t end) {
  return {begin, end};
}
template <class I>
constexpr Indices<I> indices(std::size_t count) {
  return {0, count};
}

// Numbers of a list that knows no kinds as indices: for (const auto u : as_indices<I>(graph.neighbours_of(v))).
template <class I>
class NumbersAs {
 public:
  class Iterator {
   public:
    constexpr explicit Iterator(const std::int32_t* at) : at_(at) {}
    constexpr I operator*() const { return I(*at_); }
    constexpr Iterator& operator++() { return ++at_, *this; }
    constexpr bool operator==(const Iterator&) const = default;

   private:
    const std::int32_t* at_;
  };

  constexpr explicit NumbersAs(std::span<const std::int32_t> numbers) : numbers_(numbers) {}
  constexpr Iterator begin() const { return Iterator(numbers_.data()); }
  constexpr Iterator end() const { return Iterator(numbers_.data() + numbers_.size()); }

 private:
  std::span<const std::int32_t> numbers_;
};
template <class I>
constexpr NumbersAs<I> as_indices(std::span<const std::int32_t> numbers) {
  return NumbersAs<I>(numbers);
}

// A vector with an item for each thing of a kind, which no index of another kind and no other number indexes.
template <class I, class T>
class IndexedVector : public std::vector<T> {
 public:
  using std::vector<T>::vector;
  IndexedVector() = default;
  explicit IndexedVector(std::vector<T> items) : std::vector<T>(std::move(items)) {}

  decltype(auto) operator[](I i) { return std::vector<T>::operator[](static_cast<std::size_t>(i)); }
  decltype(auto) operator[](I i) const { return std::vector<T>::operator[](static_cast<std::size_t>(i)); }
};

}  // namespace hexpipe
