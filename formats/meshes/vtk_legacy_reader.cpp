#include "formats/meshes/vtk_legacy.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/meshes/cell_data.hpp"
#include "formats/meshes/vtk_grid.hpp"
#include "formats/streams/scalar_bytes.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

constexpr std::string_view vtk_magic = "# vtk DataFile Version";

// VTK writes its vtkIdType as int, whatever its size in memory; "long" has the width that it has on our systems.
constexpr std::pair<std::string_view, ScalarType> legacy_type_names[] = {
    {"char", ScalarType::int8},
    {"signed_char", ScalarType::int8},
    {"unsigned_char", ScalarType::uint8},
    {"short", ScalarType::int16},
    {"unsigned_short", ScalarType::uint16},
    {"int", ScalarType::int32},
    {"unsigned_int", ScalarType::uint32},
    {"long", ScalarType::int64},
    {"unsigned_long", ScalarType::uint64},
    {"vtkIdType", ScalarType::int32},
    {"float", ScalarType::float32},
    {"double", ScalarType::float64},
    {"vtktypeint8", ScalarType::int8},
    {"vtktypeuint8", ScalarType::uint8},
    {"vtktypeint16", ScalarType::int16},
    {"vtktypeuint16", ScalarType::uint16},
    {"vtktypeint32", ScalarType::int32},
    {"vtktypeuint32", ScalarType::uint32},
    {"vtktypeint64", ScalarType::int64},
    {"vtktypeuint64", ScalarType::uint64},
};

// Data sets with one array of a fixed number of components, which are all skipped.
constexpr std::pair<std::string_view, int> plain_attributes[] = {
    {"VECTORS", 3},    {"NORMALS", 3},      {"TENSORS", 9},   {"TENSORS6", 6},
    {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1}, {"EDGE_FLAGS", 1}};

struct PolygonKind {
  std::string_view section;
  std::uint8_t type;  // of an unstructured grid
};
// In the order in which their data come.
constexpr std::array<PolygonKind, 4> polygon_kinds{
    {{"VERTICES", 2}, {"LINES", 4}, {"POLYGONS", 7}, {"TRIANGLE_STRIPS", 6}}};

class VtkLegacyReader {
 public:
  VtkLegacyReader(std::string_view text, std::string_view file) : text_(text), file_(file), scanner_(text, file) {}

  MixedMesh read() {
    read_header();
    while (!scanner_.at_end()) read_section(scanner_.word("a section"));
    if (!has_points_) scanner_.fail("expected POINTS, found none");
    if (has_polygons_) join_kinds();
    if (!has_cells_) scanner_.fail("expected CELLS, found none");
    if (!has_types_) scanner_.fail("expected CELL_TYPES, found none");
    if (data_size_ && !has_attribute_) scanner_.fail_expected("an attribute", "");
    return to_mixed_mesh(std::move(grid_), file_);
  }

 private:
  void read_header() {
    const std::string_view first = scanner_.rest_of_line();
    if (!first.starts_with(vtk_magic)) scanner_.fail_expected(vtk_magic, first);
    TextScanner version(first.substr(vtk_magic.size()), file_);
    version_ = version.number<double>("a version of the format");
    if (version_ < 1 || version_ >= 6) version.fail("expected a version from 1.0 to 5.1, found another");
    scanner_.rest_of_line();  // title
    const std::string_view kind = scanner_.word("ASCII or BINARY");
    binary_ = equal_ignoring_case(kind, "BINARY");
    if (!binary_ && !equal_ignoring_case(kind, "ASCII")) scanner_.fail_expected("ASCII or BINARY", kind);
    // Nothing marks the end of such a file, so only this tells a last number from the beginning of one.
    if (!binary_) expect_last_line_end(text_, file_);
    scanner_.expect("DATASET");
    const std::string_view data_set = scanner_.word("UNSTRUCTURED_GRID or POLYDATA");
    has_polygons_ = equal_ignoring_case(data_set, "POLYDATA");
    if (!has_polygons_ && !equal_ignoring_case(data_set, "UNSTRUCTURED_GRID"))
      scanner_.fail_expected("UNSTRUCTURED_GRID or POLYDATA", data_set);
  }

  void read_section(std::string_view keyword) {
    if (equal_ignoring_case(keyword, "POINTS")) return read_points();
    for (std::size_t kind = 0; kind < kinds_.size() && has_polygons_; ++kind)
      if (equal_ignoring_case(keyword, polygon_kinds[kind].section)) return read_kind(kind);
    if (equal_ignoring_case(keyword, "CELLS") && !has_polygons_) return read_cells("CELLS");
    if (equal_ignoring_case(keyword, "CELL_TYPES") && !has_polygons_) return read_types();
    if (equal_ignoring_case(keyword, "CELL_DATA")) return begin_data(true);
    if (equal_ignoring_case(keyword, "POINT_DATA")) return begin_data(false);
    if (equal_ignoring_case(keyword, "METADATA")) return skip_metadata();
    if (equal_ignoring_case(keyword, "FIELD")) return read_field();
    if (!data_size_)
      scanner_.fail_expected(has_polygons_ ? "POINTS, POLYGONS, TRIANGLE_STRIPS, CELL_DATA or POINT_DATA"
                                           : "POINTS, CELLS, CELL_TYPES, CELL_DATA or POINT_DATA",
                             keyword);
    read_attribute(keyword);
  }

  void read_points() {
    const std::size_t count = scanner_.count("the number of points", 1);
    const std::string_view type = scanner_.word("the type of the points");
    const std::size_t numbers = product(count, 3);
    if (binary_) {
      const auto values = read_binary<double>(numbers, type, "coordinates");
      grid_.points.resize(count);
      for (std::size_t i = 0; i < count; ++i) grid_.points[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    } else {
      scalar_type(type);
      expect_room_for(numbers);
      grid_.points.reserve(count);
      for (std::size_t i = 0; i < count; ++i) grid_.points.push_back(scanner_.point());
    }
    has_points_ = true;
  }

  // Cells of one kind. They are joined when all are read, because their data come in the order of the kinds.
  void read_kind(std::size_t kind) {
    if (kinds_[kind].read)
      scanner_.fail(fmt::format("expected one section {}, found a second", polygon_kinds[kind].section));
    read_cells(polygon_kinds[kind].section);
    kinds_[kind] = {true, std::exchange(grid_.ends, {}), std::exchange(grid_.connectivity, {})};
    has_cells_ = false;
  }

  void join_kinds() {
    if (has_types_) return;
    for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
      const auto shift = static_cast<std::int64_t>(grid_.connectivity.size());
      for (const std::int64_t end : kinds_[kind].ends) grid_.ends.push_back(end + shift);
      grid_.connectivity.insert(grid_.connectivity.end(), kinds_[kind].corners.begin(), kinds_[kind].corners.end());
      grid_.types.insert(grid_.types.end(), kinds_[kind].ends.size(), polygon_kinds[kind].type);
    }
    has_cells_ = has_types_ = true;
  }

  void read_cells(std::string_view section) {
    if (!has_points_) scanner_.fail(fmt::format("expected POINTS before {}", section));
    if (has_cells_) scanner_.fail(fmt::format("expected one section {}, found a second", section));
    const auto first = scanner_.count("the number of cells", 1);
    const auto second = scanner_.count("the size of the list of cells", 1);
    if (version_ >= 5) {
      read_offsets_and_connectivity(first, second);
    } else if (binary_) {
      take_counted_cells(first, read_binary<Vertex>(second, "int", "cells"));
    } else {
      read_counted_cells(first, second);
    }
    has_cells_ = true;
  }

  // From version 5 on: one offset more than cells, beginning with 0.
  void read_offsets_and_connectivity(std::size_t offset_count, std::size_t corner_count) {
    scanner_.expect("OFFSETS");
    const std::string_view offset_type = scanner_.word("a type");
    grid_.ends = read_numbers<std::int64_t>(offset_count, offset_type, "offsets");
    scanner_.expect("CONNECTIVITY");
    const std::string_view type = scanner_.word("a type");
    grid_.connectivity = read_numbers<Vertex>(corner_count, type, "connectivity");
    if (grid_.ends.empty()) return;
    if (grid_.ends.front() != 0)
      scanner_.fail(fmt::format("expected offsets that begin with 0, found {}", grid_.ends.front()));
    grid_.ends.erase(grid_.ends.begin());
  }

  // Up to version 4: each cell is its number of corners and the corners.
  void take_counted_cells(std::size_t count, const std::vector<Vertex>& numbers) {
    grid_.ends.reserve(count);
    grid_.connectivity.reserve(numbers.size());
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (at == numbers.size()) scanner_.fail(fmt::format("expected {} cells, found {}", count, i));
      const Vertex corners = numbers[at++];
      if (corners < 0 || static_cast<std::size_t>(corners) > numbers.size() - at)
        scanner_.fail(fmt::format("cell {}: expected a number of corners, found {}", i, corners));
      const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(at);
      grid_.connectivity.insert(grid_.connectivity.end(), begin, begin + corners);
      at += static_cast<std::size_t>(corners);
      grid_.ends.push_back(static_cast<std::int64_t>(grid_.connectivity.size()));
    }
    if (at != numbers.size())
      scanner_.fail(fmt::format("expected {} numbers for the cells, found {}", numbers.size(), at));
  }

  void read_counted_cells(std::size_t count, std::size_t numbers) {
    expect_room_for(numbers);
    if (count > numbers) scanner_.fail(fmt::format("expected at least {} numbers, found {}", count, numbers));
    grid_.ends.reserve(count);
    grid_.connectivity.reserve(numbers - count);
    const std::string range = fmt::format("a point from 0 to below {}", grid_.points.size());
    for (std::size_t i = 0; i < count; ++i) {
      const auto corners = scanner_.count("a number of corners", 2);
      for (std::size_t k = 0; k < corners; ++k) {
        const auto v = scanner_.number<Vertex>(range);
        if (v < 0 || static_cast<std::size_t>(v) >= grid_.points.size())
          scanner_.fail_expected(range, std::to_string(v));
        grid_.connectivity.push_back(v);
      }
      grid_.ends.push_back(static_cast<std::int64_t>(grid_.connectivity.size()));
    }
    if (grid_.connectivity.size() + count != numbers)
      scanner_.fail(
          fmt::format("expected {} numbers for the cells, found {}", numbers, grid_.connectivity.size() + count));
  }

  void read_types() {
    const std::size_t count = scanner_.count("the number of cell types", 1);
    grid_.types = read_numbers<std::uint8_t>(count, "int", "cell types");
    has_types_ = true;
  }

  void begin_data(bool of_cells) {
    if (has_polygons_) join_kinds();
    data_size_ = scanner_.number<std::size_t>("the number of entries");
    data_of_cells_ = of_cells;
    has_attribute_ = false;
    const std::size_t expected = of_cells ? grid_.types.size() : grid_.points.size();
    if (*data_size_ != expected)
      scanner_.fail_expected(fmt::format("{} entries", expected), std::to_string(*data_size_));
  }

  void read_attribute(std::string_view keyword) {
    has_attribute_ = true;
    if (equal_ignoring_case(keyword, "SCALARS")) return read_scalars();
    for (const auto& [name, components] : plain_attributes)
      if (equal_ignoring_case(keyword, name)) {
        scanner_.word("a name");
        return skip_numbers(product(*data_size_, components), scanner_.word("a type"));
      }
    scanner_.word("a name");
    const auto width = scanner_.number<std::uint32_t>("a size");
    if (equal_ignoring_case(keyword, "LOOKUP_TABLE"))
      skip_numbers(product(width, 4), "unsigned_char");
    else if (equal_ignoring_case(keyword, "COLOR_SCALARS"))
      skip_numbers(product(*data_size_, width), "unsigned_char");
    else if (equal_ignoring_case(keyword, "TEXTURE_COORDINATES"))
      skip_numbers(product(*data_size_, width), scanner_.word("a type"));
    else
      scanner_.fail_expected("an attribute of cells or points", keyword);
  }

  void read_scalars() {
    const std::string_view name = scanner_.word("a name");
    const std::string_view type = scanner_.word("a type");
    std::size_t components = 1;
    if (!scanner_.at_line_end()) components = scanner_.number<std::uint32_t>("a number of components");
    if (equal_ignoring_case(scanner_.peek_word(), "LOOKUP_TABLE")) {
      scanner_.word("LOOKUP_TABLE");
      scanner_.word("the name of a lookup table");
    }
    take_array(name, type, components, *data_size_);
  }

  void read_field() {
    has_attribute_ = true;
    scanner_.word("a name");
    const std::size_t arrays = scanner_.count("the number of arrays", 1);
    for (std::size_t i = 0; i < arrays; ++i) {
      if (equal_ignoring_case(scanner_.peek_word(), "METADATA")) skip_metadata();
      const std::string_view name = scanner_.word("the name of an array");
      const auto components = scanner_.number<std::uint32_t>("a number of components");
      const auto tuples = scanner_.number<std::size_t>("a number of entries");
      take_array(name, scanner_.word("a type"), components, tuples);
    }
  }

  void take_array(std::string_view name, std::string_view type, std::size_t components, std::size_t tuples) {
    const bool of_cells = data_size_ && data_of_cells_ && components == 1;
    if (of_cells && is_vtk_tag_name(name))
      grid_.tags[std::string(name)] = read_numbers<std::int32_t>(tuples, type, fmt::format("a tag of {}", name));
    else if (of_cells && name == quality_name)
      grid_.quality = read_numbers<double>(tuples, type, "a quality");
    else
      skip_numbers(product(tuples, components), type);
  }

  // METADATA ends with an empty line.
  void skip_metadata() {
    scanner_.rest_of_line();
    while (scanner_.bytes_left() > 0 && !scanner_.at_line_end()) scanner_.rest_of_line();
  }

  ScalarType scalar_type(std::string_view name) const {
    const auto* const found = std::ranges::find_if(
        legacy_type_names, [&](const auto& known) { return equal_ignoring_case(known.first, name); });
    if (found == std::end(legacy_type_names)) scanner_.fail_expected("a type of numbers", name);
    return found->second;
  }

  std::size_t product(std::size_t a, std::size_t b) const {
    std::size_t result = 0;
    // Every number takes a bit of the file or more.
    if (__builtin_mul_overflow(a, b, &result) || result / 8 > scanner_.bytes_left())
      scanner_.fail(fmt::format("expected numbers that the rest of the file can hold, found {} times {}", a, b));
    return result;
  }

  // In text, each number takes two bytes with what separates it.
  void expect_room_for(std::size_t numbers) const {
    if (numbers > (scanner_.bytes_left() + 1) / 2)
      scanner_.fail(fmt::format("expected {} numbers, found {} bytes", numbers, scanner_.bytes_left()));
  }

  template <class T>
  std::vector<T> read_numbers(std::size_t count, std::string_view type, std::string_view what) {
    return binary_ ? read_binary<T>(count, type, what) : read_text<T>(count, type, what);
  }

  template <class T>
  std::vector<T> read_binary(std::size_t count, std::string_view type, std::string_view what) {
    const ScalarType scalar = scalar_type(type);
    scanner_.rest_of_line();
    if (count > scanner_.bytes_left() / size_of(scalar))
      scanner_.fail(fmt::format("expected {} {}, found {} bytes", count, what, scanner_.bytes_left()));
    return convert_scalars<T>(scanner_.raw(count * size_of(scalar), what), scalar, std::endian::big,
                              fmt::format("{}: {}", file_, what));
  }

  template <class T>
  std::vector<T> read_text(std::size_t count, std::string_view type, std::string_view what) {
    const ScalarType scalar = scalar_type(type);
    const bool through_double = scalar == ScalarType::float32 || scalar == ScalarType::float64;
    expect_room_for(count);
    std::vector<T> numbers(count);
    for (T& number : numbers) number = through_double ? read_whole<T>(what) : scanner_.number<T>(what);
    return numbers;
  }

  template <class T>
  T read_whole(std::string_view what) {
    const auto number = scanner_.number<double>(what);
    if (!converts_exactly<T>(number)) scanner_.fail_expected(what, fmt::format("{}", number));
    return static_cast<T>(number);
  }

  void skip_numbers(std::size_t count, std::string_view type) {
    if (!binary_) {
      for (std::size_t i = 0; i < count; ++i) scanner_.word("a number");
      return;
    }
    const bool bits = equal_ignoring_case(type, "bit");
    const std::size_t bytes = bits ? (count + 7) / 8 : product(count, size_of(scalar_type(type)));
    scanner_.rest_of_line();
    scanner_.raw(bytes, "an array");
  }

  std::string_view text_, file_;
  TextScanner scanner_;
  VtkGrid grid_;
  double version_ = 0;
  bool binary_ = false;
  bool has_points_ = false, has_cells_ = false, has_types_ = false;
  bool has_polygons_ = false;  // in place of cells of any type
  struct Kind {
    bool read = false;
    std::vector<std::int64_t> ends;
    std::vector<Vertex> corners;
  };
  std::array<Kind, polygon_kinds.size()> kinds_;
  std::optional<std::size_t> data_size_;  // once in CELL_DATA or POINT_DATA
  bool data_of_cells_ = false;
  bool has_attribute_ = false;
};

}  // namespace

bool looks_like_vtk_legacy(std::string_view text) {
  return text.starts_with(vtk_magic);
}

MixedMesh read_vtk_legacy(std::string_view text, std::string_view file) {
  return VtkLegacyReader(text, file).read();
}

}  // namespace hexpipe::formats
