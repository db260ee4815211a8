#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "formats/meshes/abaqus.hpp"
#include "formats/meshes/grouped_mesh.hpp"
#include "formats/streams/number_map.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

struct ElementType {
  std::string_view prefix;
  std::uint8_t vtk;
  std::size_t nodes;  // of which the corners come first
};
// Longer prefixes first: C3D10M is a C3D10.
constexpr ElementType types[] = {{"C3D10", 10, 10}, {"C3D4", 10, 4},  {"C3D8", 12, 8},  {"C3D6", 13, 6},
                                 {"C3D5", 14, 5},   {"DC3D4", 10, 4}, {"DC3D8", 12, 8}, {"S3", 5, 3},
                                 {"STRI3", 5, 3},   {"CPS3", 5, 3},   {"CPE3", 5, 3},   {"M3D3", 5, 3},
                                 {"R3D3", 5, 3},    {"SFM3D3", 5, 3}, {"S4", 9, 4},     {"CPS4", 9, 4},
                                 {"CPE4", 9, 4},    {"M3D4", 9, 4},   {"R3D4", 9, 4},   {"SFM3D4", 9, 4}};
// Solids that would be another mesh by their corners, or are none.
constexpr std::string_view refused_prefixes[] = {"C3D", "DC3D", "CC3D", "STRI65", "S8", "S9"};
// These make points and elements out of others, or read them from elsewhere.
constexpr std::string_view refused_keywords[] = {"NGEN",  "NFILL",  "NCOPY",   "NMAP",
                                                 "ELGEN", "ELCOPY", "INCLUDE", "SYSTEM"};

// Corners of the faces S1, S2, ... as the manual numbers them, outward; -1: a triangle.
using Face = std::array<int, 4>;
struct Faces {
  std::uint8_t vtk;
  std::vector<Face> faces;
};
const std::vector<Face>& faces_of(std::uint8_t vtk) {
  static const std::vector<Faces> list{
      {10, {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}}},
      {12, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
      {13, {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
      {14, {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}}};
  static const std::vector<Face> none;
  const auto found = std::ranges::find(list, vtk, &Faces::vtk);
  return found == list.end() ? none : found->faces;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return fields;
}

// *ELEMENT, TYPE=C3D4, ELSET=steel
struct Keyword {
  std::string name;
  std::map<std::string, std::string> options;  // names in capitals

  std::string option(const std::string& key) const {
    const auto found = options.find(key);
    return found == options.end() ? std::string() : found->second;
  }
  bool has(const std::string& key) const { return options.contains(key); }
};

struct Range {
  std::int64_t first, last, step;
};
struct ElementSet {
  std::string name;  // as first written
  std::vector<Range> ranges;
  std::vector<std::string> sets;  // keys of earlier ones
  bool is_internal = false;       // made by Abaqus/CAE for a surface
};
struct SurfaceSide {
  std::string set;  // empty: a number
  std::int64_t element = 0;
  std::size_t face = 0;
  long line = 0;
};
struct Surface {
  std::string name;
  std::vector<SurfaceSide> sides;
};
struct Element {
  std::int64_t number;
  long line;
  std::uint8_t vtk;
  std::array<std::int64_t, 8> nodes;
  std::array<Vertex, 8> corners{};
};

class AbaqusReader {
 public:
  AbaqusReader(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  MixedMesh read(GroupNames* names) {
    read_deck();
    set_corners();
    drop_midnodes();
    number_elements();
    resolve_sets();
    add_cells();
    add_surfaces();
    return ungrouped(std::move(mesh_), names);
  }

 private:
  [[noreturn]] void fail(long line, const std::string& message) const { throw FormatError(file_, line, message); }
  [[noreturn]] void fail_expected(std::string_view what, std::string_view found) const {
    fail(line_, fmt::format("expected {}, found {}", what, found.empty() ? "nothing" : quote_found(found)));
  }

  // Without comments and empty lines.
  std::optional<std::string_view> next_line() {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      const std::string_view line = trimmed(text_.substr(at_, end - at_));
      at_ = end + 1;
      ++line_;
      if (!line.empty() && !line.starts_with("**")) return line;
    }
    return std::nullopt;
  }

  // A line of data of the keyword at hand; none before the next keyword.
  std::optional<std::string_view> next_data() {
    const std::size_t at = at_;
    const long line = line_;
    const auto text = next_line();
    if (!text || !text->starts_with('*')) return text;
    at_ = at;
    line_ = line;
    return std::nullopt;
  }

  // A line that ends with a comma goes on.
  Keyword keyword(std::string_view first) {
    std::string line(first);
    while (line.ends_with(',')) {
      const auto more = next_data();
      if (!more) break;
      line += *more;
    }
    Keyword result;
    for (const std::string_view field : fields_of(std::string_view(line).substr(1))) {
      if (result.name.empty()) {
        result.name = capitals(field);
        continue;
      }
      const std::size_t sign = field.find('=');
      const std::string_view value = sign == std::string_view::npos ? "" : trimmed(field.substr(sign + 1));
      result.options[capitals(trimmed(field.substr(0, sign)))] = value;
    }
    return result;
  }

  void read_deck() {
    while (const auto line = next_line()) {
      if (!line->starts_with('*')) continue;  // data of a keyword that says nothing about the mesh
      take(keyword(*line));
    }
    if (points_.empty()) fail(line_, "expected *NODE, found none");
  }

  void take(const Keyword& word) {
    for (const std::string_view refused : refused_keywords)
      if (word.name == refused) fail(line_, fmt::format("expected points and elements one by one, found *{}", refused));
    if (word.name == "NODE") read_nodes(word);
    if (word.name == "ELEMENT") read_elements(word);
    if (word.name == "ELSET") read_set(word);
    if (word.name == "SURFACE") read_surface(word);
    if (word.name == "SOLID SECTION" && word.has("ELSET")) sections_.insert(key_of(word.option("ELSET")));
    if (word.name == "PART" && ++parts_ > 1) fail(line_, "expected one part, found a second");
    if (word.name == "INSTANCE" && next_data())
      fail(line_, "expected an instance where its part is, found one that is moved");
  }

  // Names are the same whatever their case, and may stand in quotes.
  static std::string unquoted(std::string_view name) {
    if (name.size() >= 2 && name.starts_with('"') && name.ends_with('"')) name = name.substr(1, name.size() - 2);
    return std::string(name);
  }
  static std::string key_of(std::string_view name) { return capitals(unquoted(name)); }

  std::int64_t integer(std::string_view word, std::string_view what) const {
    std::int64_t number = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || stop != word.data() + word.size() || number < 0) fail_expected(what, word);
    return number;
  }

  // 1.5, 1.5E-3 and 1.5D-3; nothing is 0.
  double real(std::string_view word) const {
    if (word.empty()) return 0;
    std::string text(word.starts_with('+') ? word.substr(1) : word);
    for (char& c : text)
      if (c == 'D' || c == 'd') c = 'e';
    double number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool underflows = error == std::errc::result_out_of_range && text.find("e-") != std::string::npos;
    if (underflows) return 0;
    if (error != std::errc{} || stop != text.data() + text.size() || !std::isfinite(number))
      fail_expected("a coordinate", word);
    return number;
  }

  void read_nodes(const Keyword& word) {
    if (word.has("SYSTEM") && capitals(word.option("SYSTEM")) != "R")
      fail_expected("Cartesian coordinates", word.option("SYSTEM"));
    if (word.has("INPUT")) fail_expected("points in this file", word.option("INPUT"));
    while (const auto line = next_data()) {
      const auto fields = fields_of(*line);
      point_numbers_.push_back(integer(fields[0], "the number of a point"));
      const auto coordinate = [&](std::size_t i) { return real(i < fields.size() ? fields[i] : ""); };
      points_.push_back({coordinate(1), coordinate(2), coordinate(3)});
    }
  }

  // Null: lines, masses and others that we have none of.
  const ElementType* type_of(const std::string& name) const {
    for (const ElementType& type : types) {
      if (!name.starts_with(type.prefix)) continue;
      const std::string_view rest = std::string_view(name).substr(type.prefix.size());
      if (rest.empty() || rest[0] < '0' || rest[0] > '9') return &type;
    }
    for (const std::string_view prefix : refused_prefixes)
      if (name.starts_with(prefix))
        fail(line_, fmt::format("expected C3D4, C3D5, C3D6, C3D8 or C3D10, found {}", quote_found(name)));
    return nullptr;
  }

  void read_elements(const Keyword& word) {
    if (word.has("INPUT")) fail_expected("elements in this file", word.option("INPUT"));
    const ElementType* const type = type_of(capitals(word.option("TYPE")));
    ElementSet* const set = word.has("ELSET") ? &set_named(word.option("ELSET")) : nullptr;
    if (type == nullptr) return;
    std::vector<std::int64_t> numbers;
    while (const auto line = next_data()) {
      for (const std::string_view field : fields_of(*line))
        if (!field.empty()) numbers.push_back(integer(field, "the number of an element or a point"));
      if (numbers.size() < type->nodes + 1) continue;  // an element of several lines
      if (numbers.size() > type->nodes + 1) fail_count(*type, numbers);
      add_element(*type, numbers);
      if (set != nullptr) set->ranges.push_back({numbers[0], numbers[0], 1});
      numbers.clear();
    }
    if (!numbers.empty()) fail_count(*type, numbers);
  }

  [[noreturn]] void fail_count(const ElementType& type, const std::vector<std::int64_t>& numbers) const {
    fail(line_, fmt::format("expected {} points of an element, found {}", type.nodes, numbers.size() - 1));
  }

  void add_element(const ElementType& type, const std::vector<std::int64_t>& numbers) {
    Element element{numbers[0], line_, type.vtk, {}};
    const auto corners = static_cast<std::size_t>(corners_of_kind(type.vtk));
    std::copy_n(numbers.begin() + 1, corners, element.nodes.begin());
    midnodes_.insert(midnodes_.end(), numbers.begin() + 1 + static_cast<std::ptrdiff_t>(corners), numbers.end());
    // A pyramid for solvers that have none.
    const auto apex = element.nodes.begin() + 4;
    if (type.vtk == 12 && std::all_of(apex, element.nodes.end(), [&](std::int64_t n) { return n == *apex; })) {
      element.vtk = 14;
      collapsed_.insert(element.number);
    }
    elements_.push_back(element);
  }

  ElementSet& set_named(const std::string& name) {
    const auto [place, is_new] = set_places_.try_emplace(key_of(name), sets_.size());
    if (is_new) sets_.push_back({unquoted(name), {}, {}});
    return sets_[place->second];
  }

  void read_set(const Keyword& word) {
    ElementSet& set = set_named(word.option("ELSET"));
    set.is_internal = word.has("INTERNAL");
    while (const auto line = next_data()) {
      const auto fields = fields_of(*line);
      if (word.has("GENERATE")) {
        if (fields.size() < 2) fail_expected("the first and the last number of a set", *line);
        const bool has_step = fields.size() > 2 && !fields[2].empty();
        const std::int64_t step = has_step ? integer(fields[2], "a step") : 1;
        if (step < 1) fail_expected("a step of at least 1", fields[2]);
        set.ranges.push_back({integer(fields[0], "a number"), integer(fields[1], "a number"), step});
        continue;
      }
      for (const std::string_view field : fields) add_member(set, field);
    }
  }

  void add_member(ElementSet& set, std::string_view field) {
    if (field.empty()) return;
    if (is_number(field)) {
      const std::int64_t number = integer(field, "the number of an element");
      set.ranges.push_back({number, number, 1});
      return;
    }
    const auto found = set_places_.find(key_of(field));
    if (found == set_places_.end() || &sets_[found->second] >= &set)
      fail_expected("a number, or a set that stands before", field);
    set.sets.push_back(found->first);
  }

  static bool is_number(std::string_view field) { return field[0] >= '0' && field[0] <= '9'; }

  void read_surface(const Keyword& word) {
    const std::string type = capitals(word.option("TYPE"));
    if (!type.empty() && type != "ELEMENT") return;
    const std::string name = word.option("NAME");
    const auto [place, is_new] = surface_places_.try_emplace(key_of(name), surfaces_.size());
    if (is_new) surfaces_.push_back({unquoted(name), {}});
    while (const auto line = next_data()) {
      const auto fields = fields_of(*line);
      const std::string side = fields.size() > 1 ? capitals(fields[1]) : "";
      if (side == "SPOS" || side == "SNEG") continue;  // of a shell, which is a facet itself
      if (side.size() != 2 || side[0] != 'S' || side[1] < '1' || side[1] > '6') fail_expected("a face, S1 to S6", side);
      SurfaceSide entry{"", 0, static_cast<std::size_t>(side[1] - '1'), line_};
      if (!fields[0].empty() && is_number(fields[0]))
        entry.element = integer(fields[0], "the number of an element");
      else
        entry.set = key_of(fields[0]);
      surfaces_[place->second].sides.push_back(std::move(entry));
    }
  }

  void set_corners() {
    const NumberMap places(point_numbers_);
    if (const auto repeated = places.repeated())
      fail(line_, fmt::format("expected points of different numbers, found {} twice", *repeated));
    for (Element& element : elements_)
      for (std::size_t i = 0; i < static_cast<std::size_t>(corners_of_kind(element.vtk)); ++i) {
        element.corners[i] = places.find(element.nodes[i]);
        if (element.corners[i] == no_index)
          fail(element.line, fmt::format("expected the number of a point, found {}", element.nodes[i]));
      }
    for (std::int64_t& node : midnodes_) node = places.find(node);
  }

  // Points in the middle of edges, unless they are corners elsewhere: without them the mesh is one of first order.
  void drop_midnodes() {
    std::vector<bool> dropped(points_.size(), false);
    for (const std::int64_t node : midnodes_)
      if (node != no_index) dropped[static_cast<std::size_t>(node)] = true;
    for (const Element& element : elements_)
      for (std::size_t i = 0; i < static_cast<std::size_t>(corners_of_kind(element.vtk)); ++i)
        dropped[static_cast<std::size_t>(element.corners[i])] = false;
    std::vector<Vertex> places(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      places[i] = static_cast<Vertex>(mesh_.points.size());
      if (!dropped[i]) mesh_.points.push_back(points_[i]);
    }
    for (Element& element : elements_)
      for (std::size_t i = 0; i < static_cast<std::size_t>(corners_of_kind(element.vtk)); ++i)
        element.corners[i] = places[static_cast<std::size_t>(element.corners[i])];
  }

  void number_elements() {
    std::ranges::stable_sort(elements_, {}, &Element::number);
    const auto repeated = std::ranges::adjacent_find(elements_, {}, &Element::number);
    if (repeated != elements_.end())
      fail(repeated[1].line, fmt::format("expected elements of different numbers, found {} twice", repeated->number));
  }

  // Calls visit(i) for the elements of a range.
  template <class Visit>
  void visit_range(const Range& range, Visit&& visit) const {
    auto at = std::ranges::lower_bound(elements_, range.first, {}, &Element::number);
    for (; at != elements_.end() && at->number <= range.last; ++at)
      if ((at->number - range.first) % range.step == 0) visit(static_cast<std::size_t>(at - elements_.begin()));
  }

  // Elements of each set, by their places. Sets only have sets that stand before them.
  void resolve_sets() {
    for (const ElementSet& set : sets_) {
      std::vector<std::size_t> members;
      for (const Range& range : set.ranges) visit_range(range, [&](std::size_t i) { members.push_back(i); });
      for (const std::string& key : set.sets) {
        const std::vector<std::size_t>& others = members_[set_places_.at(key)];
        members.insert(members.end(), others.begin(), others.end());
      }
      std::ranges::sort(members);
      members.erase(std::ranges::unique(members).begin(), members.end());
      members_.push_back(std::move(members));
    }
  }

  // Sets of sections say what an element is; where there are none, of its sets the smallest says most.
  void add_cells() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < sets_.size(); ++i)
      if (!sets_[i].is_internal && (sections_.empty() || sections_.contains(capitals(sets_[i].name))))
        order.push_back(i);
    std::ranges::stable_sort(order,
                             [&](std::size_t a, std::size_t b) { return members_[a].size() > members_[b].size(); });
    std::vector<std::optional<std::size_t>> set_of(elements_.size());
    for (const std::size_t set : order)
      for (const std::size_t element : members_[set]) set_of[element] = set;
    std::map<std::pair<std::size_t, std::uint8_t>, ElementGroup> groups;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const Element& element = elements_[i];
      ElementGroup& group = groups[{set_of[i] ? *set_of[i] + 1 : 0, element.vtk}];
      if (group.kind == 0) {
        group.kind = element.vtk;
        group.name = set_of[i] ? clean_name(sets_[*set_of[i]].name) : "";
      }
      group.corners.insert(group.corners.end(), element.corners.begin(),
                           element.corners.begin() + corners_of_kind(element.vtk));
      group.places.push_back(static_cast<std::int64_t>(i));
    }
    for (auto& [key, group] : groups)
      (faces_of(group.kind).empty() ? mesh_.facets : mesh_.cells).push_back(std::move(group));
    number_by_name(mesh_.cells);
    number_by_name(mesh_.facets);
  }

  // From 1, in the order in which sets stand in the deck; 0 for elements of none.
  static void number_by_name(std::vector<ElementGroup>& groups) {
    std::int32_t number = 0;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      if (groups[i].name.empty()) continue;
      if (i == 0 || groups[i].name != groups[i - 1].name) ++number;
      groups[i].number = number;
    }
  }

  void add_surfaces() {
    std::int32_t number = mesh_.facets.empty() ? 0 : mesh_.facets.back().number;
    for (const Surface& surface : surfaces_) {
      ElementGroup triangles{.kind = 5, .number = ++number, .name = clean_name(surface.name)};
      ElementGroup quads{.kind = 9, .number = number, .name = triangles.name};
      for (const SurfaceSide& side : surface.sides)
        visit_elements(side, [&](const Element& element) { add_side(element, side, triangles, quads); });
      for (ElementGroup* const group : {&triangles, &quads}) {
        for (std::size_t i = 0; i < group->size(); ++i)
          group->places.push_back(static_cast<std::int64_t>(elements_.size()) + next_side_++);
        if (group->size() > 0) mesh_.facets.push_back(std::move(*group));
      }
    }
  }

  template <class Visit>
  void visit_elements(const SurfaceSide& side, Visit&& visit) const {
    if (side.set.empty())
      return visit_range({side.element, side.element, 1}, [&](std::size_t i) { visit(elements_[i]); });
    const auto found = set_places_.find(side.set);
    if (found == set_places_.end())
      fail(side.line, fmt::format("expected a set of elements, found {}", quote_found(side.set)));
    for (const std::size_t i : members_[found->second]) visit(elements_[i]);
  }

  void add_side(const Element& element, const SurfaceSide& side, ElementGroup& triangles, ElementGroup& quads) const {
    const std::vector<Face>& faces = faces_of(element.vtk);
    std::size_t face = side.face;
    // A pyramid as a hex: its sides are the hex's 3 to 6, and 2 is nothing.
    if (collapsed_.contains(element.number)) {
      if (face == 1) return;
      if (face > 1) --face;
    }
    if (faces.empty()) return;
    if (face >= faces.size())
      fail(side.line, fmt::format("expected a face up to S{}, found S{}", faces.size(), face + 1));
    const Face& corners = faces[face];
    ElementGroup& group = corners[3] < 0 ? triangles : quads;
    for (const int corner : corners)
      if (corner >= 0) group.corners.push_back(element.corners[static_cast<std::size_t>(corner)]);
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  long line_ = 0;
  int parts_ = 0;
  std::vector<std::int64_t> point_numbers_;
  std::vector<Vec3> points_;
  std::vector<Element> elements_;
  std::set<std::int64_t> collapsed_;  // hexes that are pyramids
  std::vector<std::int64_t> midnodes_;
  std::vector<ElementSet> sets_;
  std::map<std::string, std::size_t> set_places_;
  std::vector<std::vector<std::size_t>> members_;  // of each set
  std::set<std::string> sections_;
  std::vector<Surface> surfaces_;
  std::map<std::string, std::size_t> surface_places_;
  std::int64_t next_side_ = 0;
  GroupedMesh mesh_;
};

}  // namespace

bool looks_like_abaqus(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (!line.empty() && !line.starts_with("**"))
      return line.size() > 1 && line[0] == '*' &&
             ((line[1] >= 'A' && line[1] <= 'Z') || (line[1] >= 'a' && line[1] <= 'z'));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

MixedMesh read_abaqus(std::string_view text, std::string_view file, GroupNames* names) {
  return AbaqusReader(text, file).read(names);
}

}  // namespace hexpipe::formats
