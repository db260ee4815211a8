#include "formats/choice/solution_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "common/run/error.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

struct NumberedLine {
  std::int64_t number;
  long line;
};

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// One number a line; blank lines are allowed at the end only, where editors leave them.
std::vector<NumberedLine> read_lines(std::string_view text, const std::string& name) {
  std::vector<NumberedLine> lines;
  long line = 0;
  long first_blank = 0;
  while (!text.empty()) {
    ++line;
    const auto newline = text.find('\n');
    const std::string_view word = trim(text.substr(0, newline));
    text.remove_prefix(newline == std::string_view::npos ? text.size() : newline + 1);
    if (word.empty()) {
      if (first_blank == 0) first_blank = line;
      continue;
    }
    if (first_blank != 0) throw FormatError(name, first_blank, "expected a number, found an empty line");
    std::int64_t number = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || rest != word.data() + word.size())
      throw FormatError(name, line, fmt::format("expected one number, found {}", quote_found(word)));
    lines.push_back({number, line});
  }
  return lines;
}

bool is_line_for_each_vertex(const std::vector<NumberedLine>& lines, std::int64_t vertex_count) {
  return std::ssize(lines) == vertex_count &&
         std::ranges::all_of(lines, [](const NumberedLine& l) { return l.number == 0 || l.number == 1; });
}

graph::IndependentSet from_flags(const std::vector<NumberedLine>& lines) {
  graph::IndependentSet solution;
  for (std::size_t v = 0; v < lines.size(); ++v)
    if (lines[v].number == 1) solution.push_back(static_cast<std::int32_t>(v));
  return solution;
}

graph::IndependentSet from_numbers(const std::vector<NumberedLine>& lines, std::int64_t vertex_count,
                                   const std::string& name) {
  const auto n = static_cast<std::int32_t>(vertex_count);
  std::vector<char> chosen(n, 0);
  for (const auto& [number, line] : lines) {
    if (number < 1 || number > n)
      throw FormatError(name, line,
                        fmt::format("expected a vertex from 1 to {} (or 0 or 1 on {} lines), found {}", n, n, number));
    if (chosen[number - 1])
      throw FormatError(name, line, fmt::format("expected each vertex once, found {} again", number));
    chosen[number - 1] = 1;
  }
  graph::IndependentSet solution;
  for (std::int32_t v = 0; v < n; ++v)
    if (chosen[v]) solution.push_back(v);
  return solution;
}

}  // namespace

graph::IndependentSet read_solution(Input& input, std::int64_t vertex_count) {
  const std::string text = input.read_all();
  if (!text.empty()) expect_last_line_end(text, input.name());
  const auto lines = read_lines(text, input.name());
  // A failed program leaves an empty file. The empty set is a solution of the empty graph only.
  if (lines.empty() && vertex_count > 0) throw DataError::at(input.name(), "expected a solution, found no numbers");
  return is_line_for_each_vertex(lines, vertex_count) ? from_flags(lines)
                                                      : from_numbers(lines, vertex_count, input.name());
}

void write_solution(const graph::IndependentSet& solution, Output& output) {
  for (const std::int32_t v : solution) output.print("{}\n", v + 1);
}

}  // namespace hexpipe::formats
