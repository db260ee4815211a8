#include "formats/meshes/su2.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "formats/meshes/facet_owners.hpp"
#include "formats/meshes/group_naming.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/meshes/vtk_grid.hpp"
#include "formats/streams/number_writer.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

// Configuration files list markers as ( inlet, outlet ).
constexpr NameRules su2_rules{.format = "SU2", .longest = 255, .others = "-.:+"};

class Su2Reader {
 public:
  Su2Reader(std::string_view text, std::string_view file) : scanner_(text, file, '%') {}

  MixedMesh read(GroupNames* names) {
    while (!scanner_.at_end()) read_statement();
    if (!has_points_) scanner_.fail("expected NPOIN, found none");
    if (!has_cells_) scanner_.fail("expected NELEM, found none");
    check_vertices();
    set_surfaces(names);
    return std::move(mesh_);
  }

 private:
  // The key of "KEY= value", with blanks anywhere; the scanner stands behind the sign.
  std::string read_key() {
    std::string_view line = scanner_.word("a keyword like NPOIN=");
    const std::size_t sign = line.find('=');
    std::string key = capitals(line.substr(0, sign));
    if (sign == std::string_view::npos) {
      const std::string_view next = scanner_.word("'='");
      if (!next.starts_with('=')) scanner_.fail_expected("'=' behind a keyword", next);
      value_ = next.substr(1);
    } else {
      value_ = line.substr(sign + 1);
    }
    if (value_.empty()) value_ = scanner_.word("a value");
    return key;
  }

  template <class T>
  T number_value(std::string_view what) {
    T number{};
    const auto [stop, error] = std::from_chars(value_.data(), value_.data() + value_.size(), number);
    if (error != std::errc{} || stop != value_.data() + value_.size() || number < 0)
      scanner_.fail_expected(what, value_);
    return number;
  }

  std::size_t count_value(std::string_view what) {
    const auto count = number_value<std::int64_t>(what);
    // The shortest line of the sections is "0 0\n".
    if (static_cast<std::size_t>(count) > scanner_.bytes_left() / 2 + 1) scanner_.fail_expected(what, value_);
    return static_cast<std::size_t>(count);
  }

  void read_statement() {
    const std::string key = read_key();
    if (key == "NDIME") {
      if (number_value<int>("3 dimensions") != 3) scanner_.fail_expected("3 dimensions", value_);
    } else if (key == "NPOIN") {
      read_points();
    } else if (key == "NELEM") {
      read_cells();
    } else if (key == "MARKER_TAG") {
      names_.push_back(clean_name(value_));
    } else if (key == "MARKER_ELEMS") {
      read_marker();
    } else if (key == "NZONE" && number_value<int>("one zone") != 1) {
      scanner_.fail_expected("one zone", value_);
    } else if (key == "FFD_NBOX" || key == "NCHUNK" || key == "NPERIODIC") {
      if (number_value<int>("a number") != 0) scanner_.fail(key + ": expected none of these, found some");
    }
    // Other keywords (NMARK, SEND_RECV) say nothing about the mesh.
    if (!scanner_.at_line_end()) scanner_.rest_of_line();
  }

  void read_points() {
    if (has_points_) scanner_.fail("expected one NPOIN, found a second");
    has_points_ = true;
    const std::size_t count = count_value("the number of points");
    if (count > static_cast<std::size_t>(std::numeric_limits<Vertex>::max()))
      scanner_.fail_expected("fewer than 2^31 points", value_);
    scanner_.rest_of_line();  // may have a second number
    mesh_.points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      mesh_.points.push_back(scanner_.point());
      if (!scanner_.at_line_end()) scanner_.number<std::int64_t>("the number of a point");
    }
  }

  template <class Visit>
  void read_element(int dimension, Visit&& set_tag) {
    const auto type = scanner_.number<int>("the type of an element");
    bool known = false;
    for_each_block(mesh_, [&](const ElementNames& names, auto& block) {
      if (names.vtk != type || names.dimension != dimension) return;
      known = true;
      auto& cell = block.cells.emplace_back();
      for (Vertex& v : cell) {
        v = scanner_.number<Vertex>("a point from 0");
        if (v < 0) scanner_.fail_expected("a point from 0", std::to_string(v));
        greatest_ = std::max(greatest_, std::int64_t{v});
      }
      cell = swap_vtk_order(cell);
      set_tag(block);
    });
    if (!known)
      scanner_.fail_expected(dimension == 3 ? "a type of cell: 10, 12, 13 or 14" : "a type of facet: 5 or 9",
                             std::to_string(type));
    if (!scanner_.at_line_end()) scanner_.number<std::int64_t>("the number of an element");
  }

  void read_cells() {
    has_cells_ = true;
    const std::size_t count = count_value("the number of elements");
    for (std::size_t i = 0; i < count; ++i) read_element(3, [](auto& block) { block.tags.push_back(1); });
  }

  void read_marker() {
    const std::size_t count = count_value("the number of elements of a marker");
    if (names_.size() != markers_ + 1) scanner_.fail("expected one MARKER_TAG before each MARKER_ELEMS");
    const auto marker = static_cast<std::int32_t>(markers_++);
    for (std::size_t i = 0; i < count; ++i) read_element(2, [&](auto& block) { block.tags.push_back(marker); });
  }

  void check_vertices() {
    if (greatest_ >= static_cast<std::int64_t>(mesh_.points.size()))
      scanner_.fail(fmt::format("expected points from 0 to {}, found {}",
                                static_cast<std::int64_t>(mesh_.points.size()) - 1, greatest_));
  }

  // surface_5 gets 5; the others get the free numbers, in their order.
  void set_surfaces(GroupNames* names) {
    std::vector<std::int32_t> tags(names_.size(), 0);
    std::map<std::int32_t, std::size_t> used;
    std::vector<bool> is_told(names_.size(), false);
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (const auto tag = told_tag(names_[i], GroupKind::surface)) is_told[i] = used.emplace(tags[i] = *tag, i).second;
    std::int32_t next = 1;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (is_told[i]) continue;
      while (used.contains(next)) ++next;
      used.emplace(tags[i] = next, i);
      if (names != nullptr) names->surfaces[tags[i]] = names_[i];
    }
    for (auto* block_tags : {&mesh_.triangles.tags, &mesh_.quads.tags})
      for (std::int32_t& tag : *block_tags) tag = tags[static_cast<std::size_t>(tag)];
  }

  TextScanner scanner_;
  MixedMesh mesh_;
  std::string_view value_;
  std::vector<std::string> names_;
  std::size_t markers_ = 0;  // that have had their elements
  std::int64_t greatest_ = -1;
  bool has_points_ = false, has_cells_ = false;
};

class Su2Writer {
 public:
  Su2Writer(const MixedMesh& mesh, const MeshWriting& writing, Output& output)
      : mesh_(mesh),
        writing_(writing),
        output_(output),
        line_(output),
        names_(mesh, GroupKind::surface, writing, su2_rules) {}

  void write() {
    tell_of_regions();
    output_.print("NDIME= 3\nNELEM= {}\n", mesh_.cell_count());
    std::size_t element = 0;
    for_each_block(mesh_, [&](const ElementNames& names, const auto& block) {
      if (names.dimension != 3) return;
      for (const auto& cell : block.cells) write_element(names, cell, element++);
    });
    output_.print("NPOIN= {}\n", mesh_.points.size());
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
      const Vec3& p = mesh_.points[i];
      line_ << p.x << p.y << p.z << i;
      line_.end_line();
    }
    write_markers();
  }

 private:
  void tell_of_regions() {
    const std::size_t regions = GroupNaming(mesh_, GroupKind::region, writing_, su2_rules).list().size();
    if (regions > 1) writing_.say(fmt::format("SU2 has no regions: the cells of {} are written as one", regions));
  }

  template <class Cell>
  void write_element(const ElementNames& names, const Cell& cell, std::size_t number) {
    line_ << int{names.vtk};
    for (const Vertex v : swap_vtk_order(cell)) line_ << v;
    line_ << number;
    line_.end_line();
  }

  // A marker is a part of the boundary: SU2 finds no cell behind a facet between two.
  void write_markers() {
    const FacetOwners owners = find_facet_owners(mesh_);
    std::map<std::string, std::vector<std::string>> lines;
    std::size_t inside = 0;
    const auto collect = [&](const ElementNames& names, const auto& block, const std::vector<FacetOwner>& owner) {
      for (std::size_t i = 0; i < block.size(); ++i) {
        if (owner[i].cells != 1) {
          ++inside;
          continue;
        }
        lines[names_.of(block.tags[i])].push_back(fmt::format("{} {}", names.vtk, fmt::join(block.cells[i], " ")));
      }
    };
    collect(triangle_names, mesh_.triangles, owners.triangles);
    collect(quad_names, mesh_.quads, owners.quads);
    if (inside > 0)
      writing_.say(
          fmt::format("{} facets that are not on the boundary are left out: SU2 has no markers there", inside));
    output_.print("NMARK= {}\n", lines.size());
    for (const std::string& name : names_.list()) {
      const auto found = lines.find(name);
      if (found == lines.end()) continue;
      output_.print("MARKER_TAG= {}\nMARKER_ELEMS= {}\n", name, found->second.size());
      for (const std::string& line : found->second) output_.print("{}\n", line);
    }
  }

  const MixedMesh& mesh_;
  const MeshWriting& writing_;
  Output& output_;
  LineWriter line_;
  GroupNaming names_;
};

}  // namespace

bool looks_like_su2(std::string_view text) {
  return capitals(TextScanner(text, "", '%').peek_word()).starts_with("NDIME");
}

MixedMesh read_su2(std::string_view text, std::string_view file, GroupNames* names) {
  return Su2Reader(text, file).read(names);
}

void write_su2(const MixedMesh& mesh, const MeshWriting& writing, Output& output) {
  Su2Writer(mesh, writing, output).write();
}

}  // namespace hexpipe::formats
