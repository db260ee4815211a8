#include "formats/choice/edge_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "common/run/memory.hpp"
#include "formats/choice/edges.hpp"
#include "formats/streams/number_lines.hpp"

namespace hexpipe::formats {
namespace {

class EdgeListParser : NumberLines {
 public:
  EdgeListParser(std::string_view text, std::string_view file, LeftOut& left_out)
      : NumberLines(text, file, '#'), left_out_(left_out) {}

  graph::ConflictGraph parse() {
    expect_memory(bytes_left() / 4 + 1, 3 * sizeof(std::int32_t), file());
    while (begin_line()) {
      if (at_line_end() || peek_word().front() == '%')
        skip_line();
      else
        read_edge();
    }
    if (ends_.empty() && highest_ < 0)
      throw DataError::at(file(), "expected lines of two vertices, as 1 2, found none");
    const std::int32_t first = lowest_ == 0 ? 0 : 1;
    for (std::int32_t& v : ends_) v -= first;
    check_vertex_count(highest_ - first + 1);
    return graph_of_edges(std::vector<std::int64_t>(static_cast<std::size_t>(highest_ - first + 1), 1), ends_);
  }

 private:
  void read_edge() {
    const std::int32_t a = vertex(), b = vertex();
    while (!at_line_end()) take_word();
    end_line("the end of the line");
    if (a == b) return static_cast<void>(++left_out_.loops);
    ends_.push_back(a);
    ends_.push_back(b);
  }

  std::int32_t vertex() {
    const std::uint64_t v = number("a vertex");
    if (v >= static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
      fail(fmt::format("expected vertices below 2^31 - 1, found {}", v));
    const auto result = static_cast<std::int32_t>(v);
    lowest_ = std::min(lowest_, result);
    highest_ = std::max(highest_, result);
    return result;
  }

  // Numbers that are not a numbering (those of people, for example) would make a graph of almost only isolated
  // vertices.
  void check_vertex_count(std::int64_t count) const {
    constexpr std::int64_t isolated = 1000000;
    const auto most = static_cast<std::int64_t>(ends_.size()) + isolated;
    if (count > most)
      throw DataError::at(file(), "expected at most {} vertices in a list of {} edges, found numbers up to {}", most,
                          ends_.size() / 2, highest_);
  }

  LeftOut& left_out_;
  std::int32_t lowest_ = std::numeric_limits<std::int32_t>::max(), highest_ = -1;
  std::vector<std::int32_t> ends_;  // two an edge
};

}  // namespace

bool looks_like_edge_list(Input& input) {
  return input.peek(1) == "#";
}

graph::ConflictGraph read_edge_list(Input& input, LeftOut& left_out) {
  const std::string text = input.read_all();
  if (!text.empty()) expect_last_line_end(text, input.name());
  return EdgeListParser(text, input.name(), left_out).parse();
}

}  // namespace hexpipe::formats
