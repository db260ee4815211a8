#include "formats/choice/metis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "common/run/error.hpp"
#include "common/run/memory.hpp"
#include "formats/streams/number_lines.hpp"

namespace hexpipe::formats {
namespace {

class MetisParser : NumberLines {
 public:
  MetisParser(std::string_view text, std::string_view file, const GraphReading& reading, LeftOut& left_out)
      : NumberLines(text, file, '%'), reading_(reading), left_out_(left_out), has_last_end_(text.ends_with('\n')) {}

  graph::ConflictGraph parse() {
    read_header();
    for (std::int32_t v = 0; v < vertex_count_; ++v) read_vertex(v);
    check_nothing_follows();
    check_edge_count();
    check_both_ends();
    check_last_number();
    return std::move(graph_);
  }

 private:
  void read_header() {
    if (!begin_line()) throw DataError::at(file(), "expected a METIS graph, found an empty file");
    const std::uint64_t vertices = number("the number of vertices");
    const std::uint64_t edges = number("the number of edges");
    if (!at_line_end()) read_format();
    if (!at_line_end() && number("the number of weights a vertex") != 1)
      fail("expected one weight a vertex, found another number of them");
    end_line("the end of the header");

    if (vertices > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
      fail(fmt::format("expected fewer than 2^31 vertices, found {}", vertices));
    if (vertices > bytes_left() + 1) fail(fmt::format("expected a line for each of {} vertices, found less", vertices));
    if (edges > bytes_left() / 4 + 1) fail(fmt::format("expected both ends of {} edges, found less", edges));
    vertex_count_ = static_cast<std::int32_t>(vertices);
    directed_count_ = 2 * edges;
    expect_memory(directed_count_, sizeof(std::int32_t), file());
    graph_.offsets.reserve(vertices + 1);
    graph_.weights.reserve(vertices);
    graph_.neighbours.reserve(directed_count_);
  }

  void read_format() {
    const std::string_view word = peek_word();
    const bool digits = std::ranges::all_of(word, [](char c) { return c == '0' || c == '1'; });
    if (!digits || word.size() > 3) fail_expected("a format of the digits 0 and 1, as 10");
    if (word.size() == 3 && word[0] == '1') fail_expected("a format without vertex sizes, 0, 1, 10 or 11");
    vertex_weights_ = word.size() >= 2 && word[word.size() - 2] == '1';
    edge_weights_ = word.back() == '1';
    take_word();
  }

  void read_vertex(std::int32_t v) {
    if (!begin_line()) fail_missing_lines(v);
    std::int64_t weight = 1;
    if (vertex_weights_) weight = scaled_weight("the vertex weight", reading_.weight_scale);
    if (__builtin_add_overflow(weight_sum_, weight, &weight_sum_))
      fail("expected weights whose sum fits 64 bits, found an overflow");
    graph_.weights.push_back(weight);

    bool ascending = true;
    const auto first = graph_.neighbours.size();
    while (!at_line_end()) {
      const std::int32_t u = neighbour(v);
      if (edge_weights_) take_edge_weight();
      if (u == v) continue;
      ascending = ascending && (graph_.neighbours.size() == first || graph_.neighbours.back() < u);
      graph_.neighbours.push_back(u);
    }
    if (!ascending) sort_neighbours(first);
    graph_.offsets.push_back(static_cast<std::int64_t>(graph_.neighbours.size()));
    end_line("the end of the line");
  }

  std::int32_t neighbour(std::int32_t v) {
    const std::int32_t u = vertex_number("a neighbour", vertex_count_);
    if (u == v) {
      if (!reading_.tolerant)
        fail(fmt::format("expected no loops, found vertex {} beside itself (--tolerant leaves them out)", v + 1));
      ++left_out_.loops;
      return u;
    }
    if (!reading_.tolerant && graph_.neighbours.size() == directed_count_)
      fail(fmt::format("expected {} edges as the header says, found more", directed_count_ / 2));
    return u;
  }

  void sort_neighbours(std::size_t first) {
    const auto list = std::span(graph_.neighbours).subspan(first);
    std::ranges::sort(list);
    const auto repeated = std::ranges::adjacent_find(list);
    if (repeated == list.end()) return;
    if (!reading_.tolerant)
      fail(fmt::format("expected each neighbour once, found {} repeated (--tolerant takes it once)", *repeated + 1));
    const auto rest = std::ranges::unique(list);
    repeated_ends_ += rest.size();
    graph_.neighbours.resize(graph_.neighbours.size() - rest.size());
  }

  // Real numbers are left out as well.
  void take_edge_weight() {
    if (reading_.weight_scale)
      scaled_weight("the edge weight", reading_.weight_scale);
    else
      weight_number("the edge weight");
  }

  void check_nothing_follows() {
    while (begin_line()) {
      if (!at_line_end()) fail_expected(fmt::format("nothing after the lines of {} vertices", vertex_count_));
      end_line("the end of the line");
    }
  }

  void check_edge_count() {
    left_out_.repeated += static_cast<std::int64_t>(repeated_ends_ / 2);
    if (is_counted(graph_.neighbours.size())) return;
    throw DataError::at(file(), "expected {} edges ({} neighbours) as the header says, found {} neighbours",
                        directed_count_ / 2, directed_count_, graph_.neighbours.size());
  }

  // The header may count what is left out: repeated edges, and loops at one of their ends or at both.
  bool is_counted(std::size_t found) const {
    const auto loops = static_cast<std::size_t>(left_out_.loops);
    for (const std::size_t with_repeated : {found, found + repeated_ends_})
      for (const std::size_t with_loops : {with_repeated, with_repeated + loops, with_repeated + 2 * loops})
        if (with_loops == directed_count_) return true;
    return false;
  }

  // A file that is cut off may end with the beginning of a number. A missing neighbour would be noticed at its other
  // end.
  void check_last_number() const {
    if (has_last_end_ || !vertex_weights_ || vertex_count_ == 0 || graph_.degree(vertex_count_ - 1) > 0) return;
    throw DataError::at(file(),
                        "expected the last line to have an end, found none; is the file cut off in its last weight?");
  }

  void check_both_ends() {
    const auto edge = graph::find_one_sided_edge(graph_);
    if (!edge) return;
    throw FormatError(file(), line_of_vertex(edge->from),
                      fmt::format("expected every edge at both ends, found {} beside {} but not {} beside {}",
                                  edge->to + 1, edge->from + 1, edge->from + 1, edge->to + 1));
  }

  long line_of_vertex(std::int32_t v) {
    go_back_to_begin();
    for (std::int32_t i = -1; i <= v; ++i) begin_line(), skip_line();
    return line();
  }

  [[noreturn]] void fail_missing_lines(std::int32_t found) const {
    throw FormatError(file(), line() + 1,
                      fmt::format("expected the lines of {} vertices, found {}", vertex_count_, found));
  }

  const GraphReading& reading_;
  LeftOut& left_out_;
  bool has_last_end_;
  std::size_t repeated_ends_ = 0;
  std::int32_t vertex_count_ = 0;
  std::uint64_t directed_count_ = 0;
  bool vertex_weights_ = false;
  bool edge_weights_ = false;
  std::int64_t weight_sum_ = 0;
  graph::ConflictGraph graph_;
};

}  // namespace

graph::ConflictGraph read_metis(Input& input, const GraphReading& reading, LeftOut& left_out) {
  const std::string text = input.read_all();
  return MetisParser(text, input.name(), reading, left_out).parse();
}

void write_metis(const graph::ConflictGraph& graph, Output& output) {
  output.print("{} {} 10\n", graph.vertex_count(), graph.edge_count());
  std::string line;
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    line.clear();
    const auto append = [&line](std::int64_t number) {
      const fmt::format_int digits(number);
      line.append(digits.data(), digits.size());
    };
    append(graph.weights[v]);
    for (const std::int32_t u : graph.neighbours_of(v)) {
      line.push_back(' ');
      append(u + 1);
    }
    line.push_back('\n');
    output.write(line);
  }
}

std::optional<std::string> metis_weight_warning(const graph::ConflictGraph& graph) {
  constexpr double metis_limit = 0x1p31, kamis_limit = 0x1p32;
  double total = 0;
  for (const std::int64_t weight : graph.weights) total += static_cast<double>(weight);
  if (total < metis_limit) return std::nullopt;
  std::int64_t divisor = 10;
  while (total / static_cast<double>(divisor) >= metis_limit) divisor *= 10;
  const bool kamis_too = total >= kamis_limit;
  return fmt::format("the weights sum to {:.0f}, past {}: {} without saying so; a --weight-scale {} times smaller fits",
                     total, kamis_too ? "2^32" : "2^31", kamis_too ? "METIS and KaMIS overflow" : "METIS overflows",
                     divisor);
}

}  // namespace hexpipe::formats
