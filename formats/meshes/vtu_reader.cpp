#include "formats/meshes/vtu.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <pugixml.hpp>
#include <utility>
#include <vector>

#include "formats/meshes/cell_data.hpp"
#include "formats/meshes/vtk_grid.hpp"
#include "formats/meshes/vtk_xml_data.hpp"
#include "formats/streams/scalar_bytes.hpp"
#include "formats/streams/text_scanner.hpp"
#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

constexpr std::pair<std::string_view, ScalarType> vtu_type_names[] = {
    {"Int8", ScalarType::int8},       {"UInt8", ScalarType::uint8},   {"Int16", ScalarType::int16},
    {"UInt16", ScalarType::uint16},   {"Int32", ScalarType::int32},   {"UInt32", ScalarType::uint32},
    {"Int64", ScalarType::int64},     {"UInt64", ScalarType::uint64}, {"Float32", ScalarType::float32},
    {"Float64", ScalarType::float64},
};

constexpr const char *unstructured_type = "UnstructuredGrid", *polygons_type = "PolyData";

class VtuReader {
 public:
  VtuReader(std::string text, std::string_view file) : text_(std::move(text)), file_(file) {}

  MixedMesh read(std::vector<std::string>* warnings) {
    parse_xml();
    const pugi::xml_node root = document_.child("VTKFile");
    const std::string type = root.attribute("type").value();
    if (type != unstructured_type && type != polygons_type)
      fail(root, fmt::format("expected VTKFile of type {} or {}, found {}", unstructured_type, polygons_type,
                             quote_found(type)));
    read_encoding(root);
    const pugi::xml_node content = child(root, type.c_str());
    child(content, "Piece");
    for (const pugi::xml_node piece : content.children("Piece")) {
      first_points_.push_back(static_cast<Vertex>(grid_.points.size()));
      type == polygons_type ? read_polygons(piece) : read_piece(piece);
    }
    if (first_points_.size() > 1) join_pieces(warnings);
    return to_mixed_mesh(std::move(grid_), file_);
  }

 private:
  // Writers in parallel give each piece its own copies of the points at its seams. Where a piece has several points in
  // one place, as at a crack, nothing tells which of them is meant: they stay apart.
  void join_pieces(std::vector<std::string>* warnings) {
    std::vector<Vec3> places;
    std::vector<Vertex> place_of;
    std::vector<std::size_t> last_piece;
    std::vector<bool> is_doubled;
    PointMerger merger(places);
    for (std::size_t p = 0, piece = 0; p < grid_.points.size(); ++p) {
      while (piece + 1 < first_points_.size() && static_cast<std::size_t>(first_points_[piece + 1]) <= p) ++piece;
      const Vertex place = merger.index_of(grid_.points[p]);
      const bool is_new = static_cast<std::size_t>(place) == last_piece.size();
      if (is_new) last_piece.push_back(piece), is_doubled.push_back(false);
      if (!is_new && last_piece[place] == piece) is_doubled[place] = true;
      last_piece[place] = piece;
      place_of.push_back(place);
    }
    std::vector<Vertex> first_at(places.size(), no_index), new_index(grid_.points.size());
    std::size_t kept = 0;
    for (std::size_t p = 0; p < new_index.size(); ++p) {
      Vertex& first = first_at[place_of[p]];
      const bool joins = first != no_index && !is_doubled[place_of[p]];
      if (!joins) grid_.points[kept] = grid_.points[p], first = static_cast<Vertex>(kept++);
      new_index[p] = first;
    }
    const std::size_t joined = new_index.size() - kept;
    const auto apart = static_cast<std::size_t>(std::ranges::count(is_doubled, true));
    grid_.points.resize(kept);
    for (Vertex& v : grid_.connectivity) v = new_index[v];
    if (warnings == nullptr) return;
    if (joined > 0)
      warnings->push_back(fmt::format("{}: joined {} pieces at {} points with the coordinates of others", file_,
                                      first_points_.size(), joined));
    if (apart > 0)
      warnings->push_back(
          fmt::format("{}: in {} places one piece has several points; its pieces are not joined there", file_, apart));
  }

  // Appended raw data are not XML: the text before them is parsed, with the missing end tags.
  void parse_xml() {
    constexpr unsigned flags = pugi::parse_minimal | pugi::parse_escapes;
    pugi::xml_parse_result result;
    const std::size_t appended = text_.find("<AppendedData");
    find_line_ends(std::string_view(text_).substr(0, text_.find('_', std::min(appended, text_.size()))));
    bool ends_in_tag = true;
    if (appended == std::string::npos) {
      const std::size_t last = text_.find_last_not_of(" \t\r\n");
      ends_in_tag = last != std::string::npos && text_[last] == '>';
      result = document_.load_buffer_inplace(text_.data(), text_.size(), flags, pugi::encoding_utf8);
    } else {
      const std::string head = text_.substr(0, find_appended_data(appended)) + "</AppendedData></VTKFile>";
      result = document_.load_buffer(head.data(), head.size(), flags, pugi::encoding_utf8);
    }
    if (!result)
      throw FormatError(file_, line_at(result.offset),
                        fmt::format("expected well-formed XML, found: {}", result.description()));
    // The parser takes text and elements behind the only one that XML allows.
    if (!ends_in_tag || document_.child("VTKFile").next_sibling())
      throw DataError::at(file_, "expected nothing after </VTKFile>");
  }

  // The line ends are searched before parsing: parsing in place ends names and values with zeros where line ends were.
  void find_line_ends(std::string_view xml) {
    for (std::size_t at = xml.find('\n'); at != std::string_view::npos; at = xml.find('\n', at + 1))
      line_ends_.push_back(at);
  }

  // Sets appended_; returns where the contents of the element begin.
  std::size_t find_appended_data(std::size_t tag) {
    const std::size_t begin = std::min(text_.find('>', tag), text_.size() - 1) + 1;
    const std::size_t mark = std::min(text_.find_first_not_of(" \t\r\n", begin), text_.size());
    const std::size_t end = text_.rfind("</AppendedData>");
    if (mark == text_.size() || text_[mark] != '_')
      throw FormatError(file_, line_at(begin), "expected '_' before the appended data");
    if (end == std::string::npos || end < mark)
      throw DataError::at(file_, "expected </AppendedData>, found end of file");
    TextScanner rest(std::string_view(text_).substr(end), file_);
    rest.skip_past("</AppendedData>");
    rest.expect("</VTKFile>");
    if (!rest.at_end()) throw DataError::at(file_, "expected nothing after </VTKFile>");
    appended_ = std::string_view(text_).substr(mark + 1, end - mark - 1);
    return begin;
  }

  void read_encoding(const pugi::xml_node& root) {
    const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
    encoding_.order = order == "BigEndian" ? std::endian::big : std::endian::little;
    const std::string_view header = root.attribute("header_type").as_string("UInt32");
    if (header != "UInt32" && header != "UInt64")
      fail(root, fmt::format("expected header_type UInt32 or UInt64, found {}", quote_found(header)));
    encoding_.long_header = header == "UInt64";
    const std::string_view compressor = root.attribute("compressor").value();
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      fail(root, fmt::format("expected no compressor but vtkZLibDataCompressor, found {}", quote_found(compressor)));
    encoding_.compressed = !compressor.empty();
    const std::string_view appended = root.child("AppendedData").attribute("encoding").as_string("base64");
    if (appended != "raw" && appended != "base64")
      fail(root, fmt::format("expected appended data as raw or base64, found {}", quote_found(appended)));
    appended_base64_ = appended == "base64";
  }

  void read_piece(const pugi::xml_node& piece) {
    const Vertex first_point = read_points_of(piece);
    const auto cell_count = count_attribute(piece, "NumberOfCells");
    const pugi::xml_node cells = child(piece, "Cells");
    append(grid_.types, read_array<std::uint8_t>(named_array(cells, "types"), cell_count));
    read_cells(cells, cell_count, first_point);
    for (const pugi::xml_node array : piece.child("CellData").children("DataArray"))
      read_cell_data(array, 0, cell_count);
  }

  // Points and lines, which come first, say nothing of a surface.
  void read_polygons(const pugi::xml_node& piece) {
    const Vertex first_point = read_points_of(piece);
    const auto optional_count = [&](const char* name) {
      return piece.attribute(name) ? count_attribute(piece, name) : std::size_t{0};
    };
    const std::size_t others = optional_count("NumberOfVerts") + optional_count("NumberOfLines");
    const std::size_t polygons = optional_count("NumberOfPolys"), strips = optional_count("NumberOfStrips");
    if (polygons + strips == 0) return;
    if (polygons > 0) read_cells(child(piece, "Polys"), polygons, first_point);
    if (strips > 0) read_cells(child(piece, "Strips"), strips, first_point);
    grid_.types.insert(grid_.types.end(), polygons, vtk_polygon);
    grid_.types.insert(grid_.types.end(), strips, vtk_triangle_strip);
    for (const pugi::xml_node array : piece.child("CellData").children("DataArray"))
      read_cell_data(array, others, polygons + strips);
  }

  Vertex read_points_of(const pugi::xml_node& piece) {
    const auto point_count = count_attribute(piece, "NumberOfPoints");
    const auto first_point = grid_.points.size();
    if (first_point + point_count > static_cast<std::size_t>(std::numeric_limits<Vertex>::max()))
      fail(piece, fmt::format("expected fewer than 2^31 points, found {}", first_point + point_count));
    read_points(child(piece, "Points"), point_count);
    return static_cast<Vertex>(first_point);
  }

  void read_points(const pugi::xml_node& node, std::size_t count) {
    const pugi::xml_node array = child(node, "DataArray");
    if (array.attribute("NumberOfComponents").as_int(1) != 3) fail(array, "expected points of 3 components");
    const auto numbers = read_array<double>(array, 3 * count);
    grid_.points.reserve(grid_.points.size() + count);
    for (std::size_t i = 0; i < count; ++i)
      grid_.points.push_back({numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]});
  }

  void read_cells(const pugi::xml_node& cells, std::size_t count, Vertex first_point) {
    auto ends = read_array<std::int64_t>(named_array(cells, "offsets"), count);
    const std::int64_t corner_count = ends.empty() ? 0 : ends.back();
    if (corner_count < 0) fail(cells, fmt::format("expected offsets from 0 up, found {}", corner_count));
    auto corners = read_array<Vertex>(named_array(cells, "connectivity"), static_cast<std::size_t>(corner_count));
    shift_piece(cells, ends, corners, first_point);
    append(grid_.ends, std::move(ends));
    append(grid_.connectivity, std::move(corners));
  }

  // The numbers of a piece begin with 0; it is put behind the pieces before it.
  void shift_piece(const pugi::xml_node& cells, std::vector<std::int64_t>& ends, std::vector<Vertex>& corners,
                   Vertex first_point) const {
    const auto corner_count = static_cast<std::int64_t>(corners.size());
    const Vertex point_count = static_cast<Vertex>(grid_.points.size()) - first_point;
    for (std::int64_t& end : ends) {
      if (end < 0 || end > corner_count)
        fail(cells, fmt::format("expected offsets from 0 to {}, found {}", corner_count, end));
      end += static_cast<std::int64_t>(grid_.connectivity.size());
    }
    for (Vertex& v : corners) {
      if (v < 0 || v >= point_count)
        fail(cells, fmt::format("expected points from 0 to below {}, found {}", point_count, v));
      v += first_point;
    }
  }

  // An array has a number for each cell: `others` come before those that count.
  void read_cell_data(const pugi::xml_node& array, std::size_t others, std::size_t count) {
    const std::string_view name = array.attribute("Name").value();
    if (array.attribute("NumberOfComponents").as_int(1) != 1) return;
    const auto take = [&](auto& to, auto numbers) {
      numbers.erase(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(others));
      append(to, std::move(numbers));
    };
    if (is_vtk_tag_name(name))
      take(grid_.tags[std::string(name)], read_array<std::int32_t>(array, others + count));
    else if (name == quality_name)
      take(grid_.quality, read_array<double>(array, others + count));
  }

  template <class T>
  static void append(std::vector<T>& to, std::vector<T> more) {
    if (to.empty()) {
      to = std::move(more);
      return;
    }
    // insert() makes GCC 14 warn of a copy of endless length.
    to.reserve(to.size() + more.size());
    std::ranges::copy(more, std::back_inserter(to));
  }

  template <class T>
  std::vector<T> read_array(const pugi::xml_node& array, std::size_t count) {
    const std::string_view format = array.attribute("format").as_string("ascii");
    const std::string where =
        fmt::format("{}:{}: array {}", file_, line_of(array), quote_found(array.attribute("Name").value()));
    if (format == "ascii") return read_text<T>(array, count, where);
    EncodedBytes bytes = format == "appended" ? appended_bytes(array, where)
                         : format == "binary" ? EncodedBytes(array.child_value(), true, where)
                                              : throw DataError::at(where, "expected format ascii, binary or appended");
    std::string storage;
    const std::string_view data = read_vtk_xml_data(bytes, encoding_, where, storage);
    if (format == "appended") count_appended(data.size(), where);
    auto numbers = convert_scalars<T>(data, scalar_type(array), encoding_.order, where);
    if (numbers.size() != count) throw DataError::at(where, "expected {} numbers, found {}", count, numbers.size());
    return numbers;
  }

  EncodedBytes appended_bytes(const pugi::xml_node& array, const std::string& where) const {
    const auto offset = count_attribute(array, "offset");
    if (offset > appended_.size())
      throw DataError::at(where, "expected an offset up to {}, found {}", appended_.size(), offset);
    return {appended_.substr(offset), appended_base64_, where};
  }

  // Arrays that share their data would let a small file take any amount of memory.
  void count_appended(std::size_t bytes, const std::string& where) {
    constexpr std::size_t most_compressed = 1032;  // times, by zlib
    taken_ += bytes;
    if (taken_ / (encoding_.compressed ? most_compressed : 1) > appended_.size())
      throw DataError::at(where, "expected data of its own, found the data of other arrays");
  }

  template <class T>
  std::vector<T> read_text(const pugi::xml_node& array, std::size_t count, const std::string& where) const {
    const pugi::xml_node node = array.text().data();
    const std::string_view text = node.value();
    if (count > (text.size() + 1) / 2) throw DataError::at(where, "expected {} numbers, found fewer", count);
    const ScalarType type = scalar_type(array);
    const bool through_double = type == ScalarType::float32 || type == ScalarType::float64;
    TextScanner scanner(text, file_, '\0', line_of(node ? node : array));
    std::vector<T> numbers(count);
    for (T& number : numbers) number = through_double ? read_whole<T>(scanner) : scanner.number<T>("a number");
    if (!scanner.at_end()) scanner.fail_expected(fmt::format("{} numbers only", count), scanner.peek_word());
    return numbers;
  }

  template <class T>
  static T read_whole(TextScanner& scanner) {
    const auto number = scanner.number<double>("a number");
    if (!converts_exactly<T>(number)) scanner.fail_expected("an integer", fmt::format("{}", number));
    return static_cast<T>(number);
  }

  ScalarType scalar_type(const pugi::xml_node& array) const {
    const std::string_view name = array.attribute("type").value();
    const auto* const found = std::ranges::find(vtu_type_names, name, [](const auto& known) { return known.first; });
    if (found == std::end(vtu_type_names))
      fail(array, fmt::format("expected a type of numbers, found {}", quote_found(name)));
    return found->second;
  }

  pugi::xml_node named_array(const pugi::xml_node& parent, const char* name) const {
    const pugi::xml_node array = parent.find_child_by_attribute("DataArray", "Name", name);
    if (!array) fail(parent, fmt::format("expected a DataArray named {}, found none", name));
    return array;
  }

  pugi::xml_node child(const pugi::xml_node& parent, const char* name) const {
    const pugi::xml_node node = parent.child(name);
    if (!node) fail(parent, fmt::format("expected <{}> in <{}>, found none", name, parent.name()));
    return node;
  }

  std::size_t count_attribute(const pugi::xml_node& node, const char* name) const {
    if (!node.attribute(name)) fail(node, fmt::format("expected an attribute {}, found none", name));
    TextScanner scanner(node.attribute(name).value(), file_, '\0', line_of(node));
    const auto count = scanner.number<std::size_t>(fmt::format("a number as attribute {}", name));
    // No number of items may pass what three bytes for each would take: products of it do not overflow then.
    if (count > std::numeric_limits<std::size_t>::max() / 4) scanner.fail_expected("a number of items", "a larger one");
    return count;
  }

  long line_of(const pugi::xml_node& node) const { return line_at(node.offset_debug()); }
  long line_at(std::ptrdiff_t offset) const {
    return line_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
  }
  long line_at(std::size_t offset) const {
    return 1 + (std::ranges::lower_bound(line_ends_, offset) - line_ends_.begin());
  }
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& message) const {
    throw FormatError(file_, line_of(node), message);
  }

  std::string text_;
  std::vector<std::size_t> line_ends_;
  std::string_view file_;
  pugi::xml_document document_;
  VtkXmlEncoding encoding_;
  std::string_view appended_;
  std::size_t taken_ = 0;  // bytes of appended data, uncompressed
  bool appended_base64_ = false;
  VtkGrid grid_;
  std::vector<Vertex> first_points_;  // by piece
};

}  // namespace

bool looks_like_vtu(std::string_view text) {
  // Only an XML declaration and comments come before the root.
  return TextScanner(text, "").peek_word().starts_with('<') && text.find("<VTKFile") != std::string_view::npos;
}

MixedMesh read_vtu(std::string text, std::string_view file, std::vector<std::string>* warnings) {
  return VtuReader(std::move(text), file).read(warnings);
}

}  // namespace hexpipe::formats
