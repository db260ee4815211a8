#include "tools/merge-parts/interleaving.hpp"

#include <limits>

#include "common/run/error.hpp"

namespace hexpipe::merge_parts {
namespace {

constexpr std::uint16_t nowhere = std::numeric_limits<std::uint16_t>::max();

}  // namespace

Interleaving interleave(const std::vector<std::vector<std::int32_t>>& numbers, std::int64_t count, const char* what) {
  std::int64_t rows = 0;
  for (const auto& of_part : numbers) rows += std::ssize(of_part);
  if (rows < count)
    throw DataError(fmt::format("expected the whole mesh in the parts, found {} of {} {}s", rows, count, what));
  Interleaving order{std::vector<std::uint16_t>(count, nowhere), {}};
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    std::vector<bool>& gives = order.gives.emplace_back(numbers[p].size());
    for (std::size_t i = 0; i < gives.size(); ++i) {
      std::uint16_t& part = order.part_of_row[numbers[p][i]];
      if (part != nowhere) continue;
      part = static_cast<std::uint16_t>(p);
      gives[i] = true;
    }
  }
  for (std::int64_t i = 0; i < count; ++i)
    if (order.part_of_row[i] == nowhere)
      throw DataError(fmt::format("expected the whole mesh in the parts, found {} {} in none", what, i));
  return order;
}

void check_row_count(PartReader& part, std::uint64_t wanted, std::uint64_t found) {
  if (wanted != found) throw DataError::at(part.bundle().where(), "expected {} rows, found {}", wanted, found);
}

std::int32_t list_length(PartReader& part, std::int64_t begin, std::int64_t end) {
  if (begin < 0 || end < begin || end - begin > std::numeric_limits<std::int32_t>::max())
    throw DataError::at(part.bundle().where(), "expected ascending ends of lists, found {} after {}", end, begin);
  return static_cast<std::int32_t>(end - begin);
}

void check_numbers_are_there(PartReader& part, std::size_t wanted, std::size_t found) {
  if (wanted != found)
    throw DataError::at(part.bundle().where(),
                        "expected the numbers of its rows and of what they name before it, found none");
}

void check_ends_are_there(PartReaders& parts, const ListLengths& lengths) {
  if (lengths.size() != parts.size())
    throw DataError::at(parts.front().bundle().where(), "expected the ends of its lists before it, found none");
}

ListLengths merge_offsets(PartReaders& parts, const Interleaving& order, pipeline::BundleWriter& out) {
  ListLengths lengths(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    RowReader<std::int64_t> reader(parts[p], order.rows_of(p) + 1);
    std::int64_t last = reader.next();
    for (std::uint64_t i = 0; i < order.rows_of(p); ++i) {
      const std::int64_t end = reader.next();
      lengths[p].push_back(list_length(parts[p], last, end));
      last = end;
    }
  }
  RowWriter<std::int64_t> writer(out, parts.front().name(), order.size() + 1);
  std::int64_t end = 0;
  writer.add(end);
  std::vector<std::uint64_t> at(parts.size(), 0);
  for (const std::uint16_t p : order.part_of_row) {
    while (!order.gives[p][at[p]]) ++at[p];
    writer.add(end += lengths[p][at[p]++]);
  }
  writer.flush();
  return lengths;
}

}  // namespace hexpipe::merge_parts
