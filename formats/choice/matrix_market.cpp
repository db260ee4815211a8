#include "formats/choice/matrix_market.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "common/run/memory.hpp"
#include "formats/choice/edges.hpp"
#include "formats/streams/number_lines.hpp"

namespace hexpipe::formats {
namespace {

constexpr std::string_view banner = "%%matrixmarket";

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

class MatrixMarketParser : NumberLines {
 public:
  // A comment begins with '%', as the first line does, which is read as none.
  MatrixMarketParser(std::string_view text, std::string_view file, LeftOut& left_out)
      : NumberLines(text, file, '\0'), left_out_(left_out) {}

  graph::ConflictGraph parse() {
    read_banner();
    begin_data_line();
    read_sizes();
    for (std::uint64_t i = 0; i < entries_; ++i) read_entry(i);
    if (next_data_line()) fail_expected(fmt::format("nothing after {} entries", entries_));
    return graph_of_edges(std::vector<std::int64_t>(static_cast<std::size_t>(vertices_), 1), ends_);
  }

 private:
  void read_banner() {
    begin_line();
    take_word();
    const auto word = [&] { return lower_case(peek_word()); };
    if (word() != "matrix") fail_expected("matrix, as in %%MatrixMarket matrix coordinate pattern symmetric");
    take_word();
    if (word() != "coordinate") fail_expected("coordinate, a sparse matrix");
    take_word();
    constexpr std::string_view fields[] = {"pattern", "integer", "real", "complex"};
    if (std::ranges::find(fields, word()) == std::end(fields))
      fail_expected("pattern, integer, real or complex values");
    take_word();
    constexpr std::string_view symmetries[] = {"general", "symmetric", "skew-symmetric", "hermitian"};
    if (std::ranges::find(symmetries, word()) == std::end(symmetries))
      fail_expected("general, symmetric, skew-symmetric or hermitian");
    take_word();
    end_line("the end of the line");
  }

  bool next_data_line() {
    while (begin_line()) {
      if (!at_line_end() && peek_word().front() != '%') return true;
      skip_line();
    }
    return false;
  }
  void begin_data_line() {
    if (!next_data_line()) throw DataError::at(file(), "expected the numbers of rows, columns and entries, found none");
  }

  void read_sizes() {
    const std::uint64_t rows = number("the number of rows");
    const std::uint64_t columns = number("the number of columns");
    entries_ = number("the number of entries");
    if (rows != columns) fail(fmt::format("expected a square matrix, found {} rows and {} columns", rows, columns));
    end_line("the end of the line");
    if (rows > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
      fail(fmt::format("expected fewer than 2^31 rows, found {}", rows));
    constexpr std::uint64_t isolated = 1000000;
    if (rows > bytes_left() + isolated)
      fail(fmt::format("expected at most {} rows in a file of this size, found {}", bytes_left() + isolated, rows));
    if (entries_ > bytes_left() / 4 + 1) fail(fmt::format("expected {} entries, found less", entries_));
    vertices_ = static_cast<std::int32_t>(rows);
    expect_memory(entries_, 4 * sizeof(std::int32_t), file());
    ends_.reserve(2 * entries_);
  }

  void read_entry(std::uint64_t found) {
    if (!next_data_line())
      throw FormatError(file(), line() + 1, fmt::format("expected {} entries, found {}", entries_, found));
    const std::int32_t row = vertex_number("a row", vertices_), column = vertex_number("a column", vertices_);
    while (!at_line_end()) take_word();
    end_line("the end of the line");
    if (row == column) return static_cast<void>(++left_out_.loops);
    ends_.push_back(row);
    ends_.push_back(column);
  }

  LeftOut& left_out_;
  std::int32_t vertices_ = 0;
  std::uint64_t entries_ = 0;
  std::vector<std::int32_t> ends_;  // two an entry
};

}  // namespace

bool looks_like_matrix_market(Input& input) {
  return lower_case(input.peek(banner.size())) == banner;
}

graph::ConflictGraph read_matrix_market(Input& input, LeftOut& left_out) {
  if (!looks_like_matrix_market(input))
    throw FormatError(input.name(), 1, "expected %%MatrixMarket matrix coordinate ..., found another line");
  const std::string text = input.read_all();
  expect_last_line_end(text, input.name());
  return MatrixMarketParser(text, input.name(), left_out).parse();
}

}  // namespace hexpipe::formats
