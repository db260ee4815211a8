#include "formats/meshes/nastran.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "formats/meshes/group_naming.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/streams/number_map.hpp"
#include "formats/streams/number_writer.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

constexpr NameRules nastran_rules{
    .format = "Nastran", .longest = 72, .others = "!#$%&'()*+,-./:;<=>?@[]^`{|}~ ", .ascii_only = false};
constexpr std::int32_t most_numbers = 99999999;  // 8 digits
constexpr int real_width = 16;
constexpr std::string_view name_comment = "$HMNAME COMP";

struct CardName {
  std::uint8_t vtk;
  std::string_view name;
};
// The first card of each kind is the one that is written.
constexpr CardName cards[] = {{12, "CHEXA"}, {13, "CPENTA"}, {14, "CPYRAM"}, {14, "CPYRA"}, {10, "CTETRA"},
                              {5, "CTRIA3"}, {9, "CQUAD4"},  {5, "CTRIAR"},  {9, "CQUADR"}};
constexpr std::string_view higher_order[] = {"CTRIA6", "CQUAD8", "CQUAD9", "CTRAX6"};

// A line without its comment, with blanks for tabs.
std::string clean_line(std::string_view line) {
  std::string text;
  for (const char c : line.substr(0, line.find('$'))) {
    if (c == '\t')
      text.append(8 - text.size() % 8, ' ');
    else if (c != '\r')
      text += c;
  }
  return text;
}

struct Card {
  std::string name;  // in capitals
  long line = 0;
  std::vector<std::string> fields;

  std::string_view field(std::size_t i) const { return i < fields.size() ? std::string_view(fields[i]) : ""; }
};

// The fields of a line: its first one, then 8, or 4 of double width.
struct LineFields {
  std::string first;
  std::vector<std::string> rest;
};

LineFields fields_of(const std::string& line) {
  LineFields result;
  std::vector<std::string> all;
  if (line.find(',') != std::string::npos) {
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(',', begin), line.size());
      all.emplace_back(trimmed(std::string_view(line).substr(begin, end - begin)));
      begin = end + 1;
    }
  } else {
    all.emplace_back(trimmed(std::string_view(line).substr(0, 8)));
    const std::size_t width = all[0].ends_with('*') || all[0].starts_with('*') ? 16 : 8;
    for (std::size_t begin = 8; begin < 72; begin += width)
      all.emplace_back(begin < line.size() ? trimmed(std::string_view(line).substr(begin, width)) : "");
  }
  result.first = all[0];
  const bool large = result.first.ends_with('*') || result.first.starts_with('*');
  result.rest.assign(all.begin() + 1, all.end());
  result.rest.resize(large ? 4 : 8);
  return result;
}

class NastranReader {
 public:
  NastranReader(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  MixedMesh read(GroupNames* names) {
    skip_to_bulk();
    while (next_card()) take_card();
    number_points();
    set_corners();
    set_tags(names);
    return std::move(mesh_);
  }

 private:
  struct Element {
    long line;
    std::array<std::int64_t, 8> nodes;
  };

  [[noreturn]] void fail(long line, const std::string& message) const { throw FormatError(file_, line, message); }
  [[noreturn]] void fail_expected(const Card& card, std::string_view what, std::string_view found) const {
    fail(card.line,
         fmt::format("expected {} in {}, found {}", what, card.name, found.empty() ? "nothing" : quote_found(found)));
  }

  std::optional<std::string_view> next_line() {
    if (at_ >= text_.size()) return std::nullopt;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    return line;
  }

  // Skips what precedes the bulk data, if the file announces them: it is for the solver only.
  void skip_to_bulk() {
    const std::size_t at = at_;
    while (const auto line = next_line())
      if (is_begin_bulk(*line)) return;
    at_ = at;
    line_ = 0;
  }

  static bool is_begin_bulk(std::string_view line) {
    TextScanner words(line, "", '$');
    if (!equal_ignoring_case(words.peek_word(), "BEGIN")) return false;
    words.word("");
    const std::string_view second = words.peek_word();
    return second.empty() || equal_ignoring_case(second.substr(0, 4), "BULK");
  }

  bool next_card() {
    card_ = {};
    while (true) {
      if (!ahead_) {
        const auto line = next_line();
        if (!line) return !card_.name.empty();
        if (line->starts_with(name_comment)) note_name(line->substr(name_comment.size()));
        std::string text = clean_line(*line);
        if (trimmed(text).empty()) continue;
        ahead_ = fields_of(text);
      }
      const bool continues = ahead_->first.empty() || ahead_->first[0] == '+' || ahead_->first[0] == '*';
      if (!card_.name.empty() && !continues) return true;
      if (card_.name.empty() && continues) fail(line_, "expected a card, found the continuation of one");
      if (card_.name.empty()) {
        card_.line = line_;
        card_.name = capitals(std::string_view(ahead_->first).substr(0, ahead_->first.find('*')));
        if (card_.name == "ENDDATA") at_ = text_.size();
      }
      card_.fields.insert(card_.fields.end(), ahead_->rest.begin(), ahead_->rest.end());
      ahead_.reset();
    }
  }

  // 12"steel"
  void note_name(std::string_view text) {
    const std::size_t quote = text.find('"'), end = text.rfind('"');
    if (quote == std::string_view::npos || end <= quote) return;
    const std::string_view number = trimmed(text.substr(0, quote));
    std::int32_t property = 0;
    const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), property);
    if (error == std::errc{} && stop == number.data() + number.size())
      names_[property] = clean_name(text.substr(quote + 1, end - quote - 1));
  }

  std::int64_t integer(std::size_t field, std::string_view what) const {
    const std::string_view word = card_.field(field);
    std::int64_t number = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || stop != word.data() + word.size() || number < 0) fail_expected(card_, what, word);
    return number;
  }

  // 1.5, 1.5E-3, 1.5D-3 and 1.5-3; nothing is 0.
  double real(std::size_t field) const {
    const std::string_view word = card_.field(field);
    if (word.empty()) return 0;
    std::string text;
    for (const char c : word) {
      const bool is_sign = c == '+' || c == '-';
      if (is_sign && !text.empty() && text.back() != 'e') text += 'e';
      if (c == 'D' || c == 'd' || c == 'E')
        text += 'e';
      else if (c != '+')
        text += c;
    }
    double number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool underflows = error == std::errc::result_out_of_range && text.find("e-") != std::string::npos;
    if (underflows) return 0;
    if (error != std::errc{} || stop != text.data() + text.size() || !std::isfinite(number))
      fail_expected(card_, "a coordinate", word);
    return number;
  }

  void take_card() {
    if (card_.name == "GRID") return take_point();
    for (const std::string_view name : higher_order)
      if (card_.name == name) fail(card_.line, fmt::format("expected elements of first order only, found {}", name));
    for (const CardName& known : cards)
      if (known.name == card_.name) take_element(known.vtk);
  }

  void take_point() {
    if (const std::string_view system = card_.field(1); !system.empty() && system != "0")
      fail(card_.line,
           fmt::format("expected points in the basic coordinate system, found system {}", quote_found(system)));
    point_numbers_.push_back(integer(0, "the number of a point"));
    mesh_.points.push_back({real(2), real(3), real(4)});
  }

  void take_element(std::uint8_t vtk) {
    std::size_t index = 0;
    for_each_block(mesh_, [&](const ElementNames& names, auto& block) {
      auto& elements = elements_[index++];
      if (names.vtk != vtk) return;
      constexpr std::size_t corners = corners_of_block<std::remove_cvref_t<decltype(block)>>;
      Element element{card_.line, {}};
      integer(0, "the number of an element");
      for (std::size_t i = 0; i < corners; ++i) element.nodes[i] = integer(2 + i, "the number of a point");
      if (names.dimension == 3)
        for (std::size_t i = 2 + corners; i < card_.fields.size(); ++i)
          if (!card_.field(i).empty() && card_.field(i)[0] != '+')
            fail(card_.line,
                 fmt::format("expected elements of first order only, found a {} of more points", names.one));
      const std::int64_t property = card_.field(1).empty() ? 0 : integer(1, "the number of a property");
      if (property > std::numeric_limits<std::int32_t>::max())
        fail_expected(card_, "a property of 31 bits", card_.field(1));
      elements.push_back(element);
      block.tags.push_back(static_cast<std::int32_t>(property));
    });
  }

  void number_points() {
    if (point_numbers_.empty()) fail(line_, "expected GRID, found none");
    points_ = NumberMap(point_numbers_);
    if (const auto repeated = points_.repeated())
      fail(line_, fmt::format("expected points of different numbers, found {} twice", *repeated));
  }

  void set_corners() {
    std::size_t index = 0;
    for_each_block(mesh_, [&](const ElementNames&, auto& block) {
      for (const Element& element : elements_[index++]) {
        auto& cell = block.cells.emplace_back();
        for (std::size_t i = 0; i < cell.size(); ++i) {
          cell[i] = points_.find(element.nodes[i]);
          if (cell[i] == no_index)
            fail(element.line, fmt::format("expected the number of a point, found {}", element.nodes[i]));
        }
      }
    });
  }

  // Properties of a dimension that elements have.
  std::set<std::int32_t> properties(int dimension) const {
    std::set<std::int32_t> result;
    for_each_block(mesh_, [&](const ElementNames& names, const auto& block) {
      if (names.dimension == dimension) result.insert(block.tags.begin(), block.tags.end());
    });
    return result;
  }

  // Properties that tell a tag in their names have it, unless another property of the dimension has that number.
  void set_tags(GroupNames* names) {
    const std::array<std::set<std::int32_t>, 2> used{properties(2), properties(3)};
    for_each_block(mesh_, [&](const ElementNames& of_block, auto& block) {
      const GroupKind kind = of_block.dimension == 3 ? GroupKind::region : GroupKind::surface;
      std::map<std::int32_t, std::int32_t> tag_of;
      for (std::int32_t& tag : block.tags) {
        const auto [place, is_new] = tag_of.try_emplace(tag, tag);
        if (is_new) {
          const auto name = names_.find(tag);
          const auto told = name == names_.end() ? std::nullopt : told_tag(name->second, kind);
          if (told && !used[static_cast<std::size_t>(of_block.dimension - 2)].contains(*told))
            place->second = *told;
          else if (name != names_.end() && told != tag && names != nullptr)
            (kind == GroupKind::region ? names->regions : names->surfaces)[tag] = name->second;
        }
        tag = place->second;
      }
    });
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  long line_ = 0;
  std::optional<LineFields> ahead_;
  Card card_;
  MixedMesh mesh_;
  std::vector<std::int64_t> point_numbers_;
  NumberMap points_;
  std::array<std::vector<Element>, 6> elements_;
  std::map<std::int32_t, std::string> names_;  // by property
};

class NastranWriter {
 public:
  NastranWriter(const MixedMesh& mesh, const MeshWriting& writing, Output& output)
      : mesh_(mesh),
        output_(output),
        names_(mesh, writing, nastran_rules),
        numbers_(group_numbers(mesh, true, most_numbers)) {}

  void write() {
    check_numbers(std::max(mesh_.points.size(), element_count(mesh_)), most_numbers, output_.name());
    output_.print("$ hexpipe mesh\nBEGIN BULK\n");
    write_names(names_.surfaces, numbers_.surfaces);
    write_names(names_.regions, numbers_.regions);
    write_points();
    write_elements();
    output_.print("ENDDATA\n");
  }

 private:
  void write_names(const GroupNaming& naming, const std::map<std::int32_t, std::int32_t>& numbers) {
    for (const auto& [tag, name] : naming.all()) output_.print("{}{:>20}\"{}\"\n", name_comment, numbers.at(tag), name);
  }

  void write_points() {
    const double negligible = negligible_length(mesh_);
    const auto text = [&](double x) { return number_within(std::abs(x) < negligible ? 0 : x, real_width, true); };
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
      const Vec3& p = mesh_.points[i];
      output_.print("GRID*   {:>16}{:>16}{:>16}{:>16}\n*       {:>16}\n", i + 1, "", text(p.x), text(p.y), text(p.z));
    }
  }

  void write_elements() {
    std::int64_t element = 1;
    for_each_block(mesh_, [&](const ElementNames& names, const auto& block) {
      const auto& numbers = names.dimension == 3 ? numbers_.regions : numbers_.surfaces;
      const std::string_view card = std::ranges::find(cards, names.vtk, &CardName::vtk)->name;
      for (std::size_t i = 0; i < block.size(); ++i) {
        output_.print("{:<8}{:>8}{:>8}", card, element++, numbers.at(block.tags[i]));
        int field = 2;
        for (const Vertex v : block.cells[i]) {
          if (field++ == 8) output_.print("\n+       ");
          output_.print("{:>8}", v + 1);
        }
        output_.print("\n");
      }
    });
  }

  const MixedMesh& mesh_;
  Output& output_;
  GroupNamings names_;
  GroupNumbers numbers_;
};

}  // namespace

// Decks begin with many lines that are not bulk data.
bool looks_like_nastran(std::string_view text) {
  constexpr int most_lines = 1000;
  for (int line = 0; line < most_lines && !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string first = fields_of(clean_line(text.substr(0, end))).first;
    const std::string_view word = std::string_view(first).substr(0, first.find_first_of(" *"));
    if (equal_ignoring_case(word, "GRID") || equal_ignoring_case(word, "CEND") ||
        equal_ignoring_case(trimmed(text.substr(0, end)).substr(0, 10), "BEGIN BULK"))
      return true;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

MixedMesh read_nastran(std::string_view text, std::string_view file, GroupNames* names) {
  return NastranReader(text, file).read(names);
}

void write_nastran(const MixedMesh& mesh, const MeshWriting& writing, Output& output) {
  NastranWriter(mesh, writing, output).write();
}

}  // namespace hexpipe::formats
