#pragma once
// Puts rows of several parts together to the rows of a whole: from which part each row comes, and which rows a part
// gives. A part gives its rows in its own order.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/merge-parts/part_reader.hpp"

namespace hexpipe::merge_parts {

struct Interleaving {
  std::vector<std::uint16_t> part_of_row;
  std::vector<std::vector<bool>> gives;  // by part and row of the part

  std::uint64_t size() const { return part_of_row.size(); }
  std::uint64_t rows_of(std::size_t part) const { return gives[part].size(); }
};

// `numbers` are those of the rows in the whole, by part, ascending. A row that several parts have comes from the first
// of them. Throws DataError, which says `what` the rows are, when one is missing, before it takes memory for more rows
// than the parts have.
Interleaving interleave(const std::vector<std::vector<std::int32_t>>& numbers, std::int64_t count, const char* what);

// Reads the rows of an array, a block at a time.
template <class T>
class RowReader {
 public:
  RowReader(PartReader& part, std::uint64_t rows) : part_(part), left_(part.bundle().begin_rows<T>()) {
    check_rows(part, rows, left_);
  }

  const T& next() {
    if (at_ == block_.size()) fill();
    return block_[at_++];
  }
  void skip(std::uint64_t count) {
    for (; count > 0; --count) next();
  }

 private:
  static constexpr std::size_t block_bytes = 64 << 10;

  void fill() {
    block_.resize(std::min<std::uint64_t>(left_, block_bytes / sizeof(T)));
    part_.bundle().read_next_rows(block_.data(), block_.size());
    part_.count(block_.size() * sizeof(T));
    left_ -= block_.size();
    at_ = 0;
  }
  static void check_rows(PartReader& part, std::uint64_t wanted, std::uint64_t found);

  PartReader& part_;
  std::uint64_t left_;
  std::vector<T> block_;
  std::size_t at_ = 0;
};

// Throws DataError unless an array has as many rows as wanted.
void check_row_count(PartReader& part, std::uint64_t wanted, std::uint64_t found);

// Throws DataError unless the numbers of `wanted` parts came before the member at which the part stands.
void check_numbers_are_there(PartReader& part, std::size_t wanted, std::size_t found);

template <class T>
void RowReader<T>::check_rows(PartReader& part, std::uint64_t wanted, std::uint64_t found) {
  check_row_count(part, wanted, found);
}

template <class T>
class RowWriter {
 public:
  RowWriter(pipeline::BundleWriter& bundle, const std::string& name, std::uint64_t rows) : bundle_(bundle) {
    bundle.begin_rows<T>(name, rows);
    block_.reserve(block_rows);
  }
  void add(const T& row) {
    block_.push_back(row);
    if (block_.size() == block_rows) flush();
  }
  // After the last row.
  void flush() {
    bundle_.write(block_.data(), block_.size() * sizeof(T));
    block_.clear();
  }

 private:
  static constexpr std::size_t block_rows = (1 << 20) / sizeof(T);
  pipeline::BundleWriter& bundle_;
  std::vector<T> block_;
};

// A change for the functions below that leaves rows as they are.
inline constexpr auto unchanged = [](std::size_t, const auto& row) { return row; };

// Writes the member at which all parts stand, with change(part, row) in place of each row.
template <class T, class Change>
void merge_rows(PartReaders& parts, const Interleaving& order, pipeline::BundleWriter& out, Change&& change) {
  check_numbers_are_there(parts.front(), parts.size(), order.gives.size());
  std::vector<RowReader<T>> readers;
  readers.reserve(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) readers.emplace_back(parts[p], order.rows_of(p));
  std::vector<std::uint64_t> at(parts.size(), 0);
  RowWriter<T> writer(out, parts.front().name(), order.size());
  for (const std::uint16_t p : order.part_of_row) {
    for (; !order.gives[p][at[p]]; ++at[p]) readers[p].next();
    ++at[p];
    writer.add(change(p, readers[p].next()));
  }
  writer.flush();
}

// Lists have their ends in one member, and their items in the next one.
using ListLengths = std::vector<std::vector<std::int32_t>>;  // by part and list

// Throws DataError when a list of the member at which the part stands begins below 0, ends before it begins, or is too
// long.
std::int32_t list_length(PartReader& part, std::int64_t begin, std::int64_t end);

// Writes the member of ends. Returns the lengths of all lists of the parts, also of those that a part does not give.
ListLengths merge_offsets(PartReaders& parts, const Interleaving& order, pipeline::BundleWriter& out);

// Throws DataError unless the ends of the lists of all parts came before their items.
void check_ends_are_there(PartReaders& parts, const ListLengths& lengths);

// Writes change(part, item) of each item. Returns how many there are.
template <class Change>
std::uint64_t merge_items(PartReaders& parts, const Interleaving& order, const ListLengths& lengths,
                          pipeline::BundleWriter& out, Change&& change) {
  check_ends_are_there(parts, lengths);
  std::vector<RowReader<std::int32_t>> readers;
  readers.reserve(parts.size());
  std::uint64_t total = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::uint64_t items = 0;
    for (std::size_t i = 0; i < lengths[p].size(); ++i) {
      items += static_cast<std::uint64_t>(lengths[p][i]);
      if (order.gives[p][i]) total += static_cast<std::uint64_t>(lengths[p][i]);
    }
    readers.emplace_back(parts[p], items);
  }
  std::vector<std::uint64_t> at(parts.size(), 0);
  RowWriter<std::int32_t> writer(out, parts.front().name(), total);
  for (const std::uint16_t p : order.part_of_row) {
    for (; !order.gives[p][at[p]]; ++at[p]) readers[p].skip(static_cast<std::uint64_t>(lengths[p][at[p]]));
    for (std::int32_t i = 0; i < lengths[p][at[p]]; ++i) writer.add(change(p, readers[p].next()));
    ++at[p];
  }
  writer.flush();
  return total;
}

}  // namespace hexpipe::merge_parts
