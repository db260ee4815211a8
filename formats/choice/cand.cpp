#include "formats/choice/cand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "common/run/error.hpp"
#include "formats/streams/number_writer.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

constexpr std::string_view cand_magic = "hexpipe-candidates";
constexpr int version = 1;
// The shortest lines are pyramids with one-digit numbers and no tets.
constexpr std::size_t least_bytes_a_candidate = 20;
constexpr std::size_t least_bytes_a_tet = 2;

std::optional<CellKind> kind_named(std::string_view name) {
  for (const CellKind kind : {CellKind::hex, CellKind::prism, CellKind::pyramid})
    if (name == name_of(kind)) return kind;
  return std::nullopt;
}

class CandParser {
 public:
  CandParser(std::string_view text, std::string_view file) : scanner_(text, file), ends_(text.ends_with('\n')) {}

  Candidates parse() {
    read_header();
    for (std::size_t i = 0; i < count_; ++i) {
      next_line();
      read_candidate();
    }
    // A file that is cut off within its last number would otherwise be taken for a different one.
    if (!ends_) scanner_.fail_expected("the end of the line", "");
    if (!scanner_.at_end()) scanner_.fail_expected("nothing after the last candidate", scanner_.peek_word());
    check_total("interior tets", tet_count_, candidates_.tets.size());
    check_total("boundary tets", boundary_tet_count_, candidates_.boundary_tets.size());
    return std::move(candidates_);
  }

 private:
  void read_header() {
    scanner_.expect(cand_magic);
    if (const int found = scanner_.number<int>("the version"); found != version)
      scanner_.fail(fmt::format("expected version {}, found {}", version, found));
    count_ = scanner_.count("a number of candidates", least_bytes_a_candidate);
    tet_count_ = scanner_.count("a number of interior tets", least_bytes_a_tet);
    boundary_tet_count_ = scanner_.count("a number of boundary tets", least_bytes_a_tet);
    end_line();
    candidates_.vertices.reserve(count_);
    candidates_.kind.reserve(count_);
    candidates_.quality.reserve(count_);
    candidates_.volume.reserve(count_);
    candidates_.tet_offsets.reserve(count_ + 1);
    candidates_.tets.reserve(tet_count_);
    candidates_.boundary_tet_offsets.reserve(count_ + 1);
    candidates_.boundary_tets.reserve(boundary_tet_count_);
  }

  void read_candidate() {
    const std::string_view name = scanner_.word("hex, prism or pyramid");
    const auto kind = kind_named(name);
    if (!kind) scanner_.fail_expected("hex, prism or pyramid", name);
    candidates_.kind.push_back(*kind);
    candidates_.quality.push_back(number<double>("the quality"));
    candidates_.volume.push_back(number<double>("the volume"));
    const auto tets = number<std::uint32_t>("the number of interior tets");
    const auto boundary_tets = number<std::uint32_t>("the number of boundary tets");
    read_vertices(*kind);
    read_tets(tets, candidates_.tets, candidates_.tet_offsets);
    read_tets(boundary_tets, candidates_.boundary_tets, candidates_.boundary_tet_offsets);
    end_line();
  }

  void read_vertices(CellKind kind) {
    std::array<Vertex, 8>& row = candidates_.vertices.emplace_back();
    row.fill(no_index);
    for (int i = 0; i < corner_count(kind); ++i) {
      const std::int32_t v = index("a vertex");
      if (std::find(row.begin(), row.begin() + i, v) != row.begin() + i)
        scanner_.fail(fmt::format("expected different vertices, found {} twice", v + 1));
      row[i] = v;
    }
  }

  void read_tets(std::uint32_t count, std::vector<TetIndex>& tets, std::vector<std::int64_t>& offsets) {
    TetIndex last;
    for (std::uint32_t i = 0; i < count; ++i) {
      const TetIndex tet(index("a tet"));
      if (tet <= last) scanner_.fail(fmt::format("expected ascending tets, found {} after {}", tet + 1, last + 1));
      tets.push_back(last = tet);
    }
    offsets.push_back(static_cast<std::int64_t>(tets.size()));
  }

  std::int32_t index(std::string_view what) {
    const auto found = number<std::int32_t>(what);
    if (found < 1) scanner_.fail(fmt::format("expected {} from 1 on, found {}", what, found));
    return found - 1;
  }

  // A candidate is one line: a missing number is not taken from the next line.
  template <class T>
  T number(std::string_view what) {
    if (scanner_.at_line_end()) scanner_.fail(fmt::format("expected {}, found the end of the line", what));
    return scanner_.number<T>(what);
  }

  void end_line() {
    if (!scanner_.at_line_end()) scanner_.fail_expected("the end of the line", scanner_.peek_word());
  }

  void next_line() {
    if (scanner_.at_end()) scanner_.fail(fmt::format("expected {} candidates, found {}", count_, candidates_.size()));
  }

  void check_total(std::string_view what, std::size_t announced, std::size_t found) {
    if (found != announced) scanner_.fail(fmt::format("expected {} {} in all, found {}", announced, what, found));
  }

  TextScanner scanner_;
  bool ends_;
  Candidates candidates_;
  std::size_t count_ = 0, tet_count_ = 0, boundary_tet_count_ = 0;
};

}  // namespace

Candidates read_cand(Input& input) {
  const std::string text = input.read_all();
  return CandParser(text, input.name()).parse();
}

void write_cand(const Candidates& candidates, Output& output) {
  LineWriter line(output);
  line << cand_magic << version << candidates.size() << candidates.tets.size() << candidates.boundary_tets.size();
  line.end_line();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto interior = candidates.interior_tets_of(i), boundary = candidates.boundary_tets_of(i);
    line << name_of(candidates.kind[i]) << candidates.quality[i] << candidates.volume[i] << interior.size()
         << boundary.size();
    for (const Vertex v : candidates.corners_of(i)) line << v + 1;
    for (const TetIndex t : interior) line << t + 1;
    for (const TetIndex t : boundary) line << t + 1;
    line.end_line();
  }
}

}  // namespace hexpipe::formats
