#include "formats/choice/dimacs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "common/run/memory.hpp"
#include "formats/choice/edges.hpp"
#include "formats/streams/number_lines.hpp"

namespace hexpipe::formats {
namespace {

class DimacsParser : NumberLines {
 public:
  DimacsParser(std::string_view text, std::string_view file, const GraphReading& reading, LeftOut& left_out)
      : NumberLines(text, file, 'c'), reading_(reading), left_out_(left_out) {}

  graph::ConflictGraph parse() {
    read_problem();
    while (begin_line()) read_line();
    graph_ = graph_of_edges(std::move(graph_.weights), ends_);
    check_edge_count();
    return std::move(graph_);
  }

 private:
  void read_problem() {
    for (;;) {
      if (!begin_line())
        throw DataError::at(file(), "expected a problem line, as p edge 3 2, found the end of the file");
      if (!at_line_end()) break;
      skip_line();
    }
    if (take_word() != "p") fail("expected a problem line, as p edge 3 2");
    take_word();
    const std::uint64_t vertices = number("the number of vertices");
    edge_count_ = number("the number of edges");
    end_line("the end of the problem line");
    if (vertices > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
      fail(fmt::format("expected fewer than 2^31 vertices, found {}", vertices));
    // Vertices without edges take no room in the file, so its size is no bound for them; no real graph has more than
    // this.
    constexpr std::uint64_t isolated = 1000000;
    if (vertices > bytes_left() + isolated)
      fail(fmt::format("expected at most {} vertices in a file of this size, found {}", bytes_left() + isolated,
                       vertices));
    if (edge_count_ > bytes_left() / 3 + 1) fail(fmt::format("expected {} edges, found less", edge_count_));
    graph_.weights.assign(vertices, 1);
    has_weight_.assign(vertices, 0);
    weight_sum_ = static_cast<std::int64_t>(vertices);
    expect_memory(edge_count_, 4 * sizeof(std::int32_t), file());  // both ends twice: the lists, and the graph of them
    ends_.reserve(2 * edge_count_);
  }

  void read_line() {
    if (at_line_end()) return skip_line();
    const std::string_view word = peek_word();
    if (word == "n" || word == "v") {
      take_word();
      read_weight();
    } else if (word == "e") {
      take_word();
      read_edge();
    } else if (word.front() >= '0' && word.front() <= '9') {
      read_edge();
    } else {
      fail_expected("a line of c, n, v or e, or an edge");
    }
    end_line("the end of the line");
  }

  void read_weight() {
    const std::int32_t v = vertex_number("a vertex", graph_.vertex_count());
    if (has_weight_[v]) fail(fmt::format("expected one weight a vertex, found another for vertex {}", v + 1));
    has_weight_[v] = 1;
    graph_.weights[v] = scaled_weight("the weight", reading_.weight_scale);
    if (__builtin_add_overflow(weight_sum_ - 1, graph_.weights[v], &weight_sum_))
      fail("expected weights whose sum fits 64 bits, found an overflow");
  }

  void read_edge() {
    const std::int32_t a = vertex_number("a vertex", graph_.vertex_count());
    const std::int32_t b = vertex_number("a vertex", graph_.vertex_count());
    if (a == b) {
      if (!reading_.tolerant)
        fail(fmt::format("expected no loops, found vertex {} beside itself (--tolerant leaves them out)", a + 1));
      return static_cast<void>(++left_out_.loops);
    }
    if (ends_.size() == 4 * edge_count_)
      fail(fmt::format("expected {} edges as the problem line says, found more than twice as many", edge_count_));
    ends_.push_back(a);
    ends_.push_back(b);
  }

  // Colouring files count an edge that comes twice as one or as two.
  void check_edge_count() {
    const std::uint64_t lines = ends_.size() / 2;
    const auto loops = static_cast<std::uint64_t>(left_out_.loops);
    if (lines != edge_count_ && lines + loops != edge_count_ &&
        static_cast<std::uint64_t>(graph_.edge_count()) != edge_count_)
      throw FormatError(file(), line(),
                        fmt::format("expected {} edges as the problem line says, found {}", edge_count_, lines));
  }

  const GraphReading& reading_;
  LeftOut& left_out_;
  std::uint64_t edge_count_ = 0;
  std::int64_t weight_sum_ = 0;
  std::vector<char> has_weight_;
  std::vector<std::int32_t> ends_;  // two an edge
  graph::ConflictGraph graph_;
};

}  // namespace

bool looks_like_dimacs(Input& input) {
  const std::string_view text = input.peek(64);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && (text[first] == 'c' || text[first] == 'p');
}

graph::ConflictGraph read_dimacs(Input& input, const GraphReading& reading, LeftOut& left_out) {
  const std::string text = input.read_all();
  if (!text.empty()) expect_last_line_end(text, input.name());
  return DimacsParser(text, input.name(), reading, left_out).parse();
}

}  // namespace hexpipe::formats
