#include "formats/surfaces/ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "formats/streams/text_scanner.hpp"
#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

enum class Type { i1, u1, i2, u2, i4, u4, f4, f8 };
enum class Encoding { ascii, little, big };

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr std::array<TypeName, 16> type_names{{{"char", Type::i1},
                                               {"int8", Type::i1},
                                               {"uchar", Type::u1},
                                               {"uint8", Type::u1},
                                               {"short", Type::i2},
                                               {"int16", Type::i2},
                                               {"ushort", Type::u2},
                                               {"uint16", Type::u2},
                                               {"int", Type::i4},
                                               {"int32", Type::i4},
                                               {"uint", Type::u4},
                                               {"uint32", Type::u4},
                                               {"float", Type::f4},
                                               {"float32", Type::f4},
                                               {"double", Type::f8},
                                               {"float64", Type::f8}}};

constexpr std::size_t size_of(Type type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(type)];
}

constexpr bool is_float(Type type) {
  return type == Type::f4 || type == Type::f8;
}

struct Property {
  std::string_view name;
  Type type;
  bool is_list = false;
  Type count_type = Type::u1;  // of a list
};

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  const Property* find(std::string_view property) const {
    const auto found = std::ranges::find(properties, property, &Property::name);
    return found == properties.end() ? nullptr : &*found;
  }
};

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
};

Type read_type(TextScanner& scanner) {
  const std::string_view word = scanner.peek_word();
  const auto found = std::ranges::find(type_names, word, &TypeName::name);
  if (found == type_names.end()) scanner.fail_expected("a PLY type", word);
  scanner.word("a PLY type");
  return found->type;
}

Encoding read_encoding(TextScanner& scanner) {
  const std::string_view word = scanner.peek_word();
  Encoding encoding = Encoding::ascii;
  if (word == "binary_little_endian")
    encoding = Encoding::little;
  else if (word == "binary_big_endian")
    encoding = Encoding::big;
  else if (word != "ascii")
    scanner.fail_expected("ascii, binary_little_endian or binary_big_endian", word);
  scanner.word("the format");
  scanner.expect("1.0");
  return encoding;
}

Property read_property(TextScanner& scanner) {
  Property property;
  property.is_list = scanner.peek_word() == "list";
  if (property.is_list) {
    scanner.expect("list");
    if (is_float(property.count_type = read_type(scanner)))
      scanner.fail("expected an integer type for a list's length");
  }
  property.type = read_type(scanner);
  property.name = scanner.word("the name of a property");
  return property;
}

bool is_remark(std::string_view keyword) {
  return keyword == "comment" || keyword == "obj_info";
}

Header read_ply_header(TextScanner& scanner) {
  Header header;
  scanner.expect("ply");
  while (is_remark(scanner.peek_word())) scanner.rest_of_line();
  scanner.expect("format");
  header.encoding = read_encoding(scanner);
  for (;;) {
    const std::string_view keyword = scanner.word("'end_header'");
    if (keyword == "end_header") break;
    if (is_remark(keyword)) {
      scanner.rest_of_line();
    } else if (keyword == "element") {
      Element element;
      element.name = scanner.word("the name of an element");
      element.count = scanner.number<std::uint64_t>("the number of elements");
      header.elements.push_back(element);
    } else if (keyword == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(read_property(scanner));
    } else {
      scanner.fail_expected("'element', 'property', 'comment' or 'end_header'", keyword);
    }
  }
  scanner.rest_of_line();
  return header;
}

// The values of the body one after the other, as text.
class AsciiBody {
 public:
  explicit AsciiBody(TextScanner& scanner) : scanner_(scanner) {}

  static constexpr std::size_t least_bytes(Type) { return 2; }
  std::size_t bytes_left() const { return scanner_.bytes_left() + 1; }  // the last value needs no separator
  // Where the next value is.
  std::int64_t place(std::uint64_t) {
    scanner_.peek_word();
    return scanner_.line();
  }
  double real(Type) { return scanner_.number<double>("a finite number"); }
  std::int64_t integer(Type) { return scanner_.number<std::int64_t>("an integer"); }
  void skip(Type) { scanner_.word("a value"); }
  void expect_end() {
    if (!scanner_.at_end()) scanner_.fail_expected("the end of the file", scanner_.peek_word());
  }
  [[noreturn]] void fail(std::string_view, std::uint64_t, const std::string& message) { scanner_.fail(message); }

 private:
  TextScanner& scanner_;
};

// The same as bytes.
class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, bool swap, const std::string& name) : bytes_(bytes), swap_(swap), name_(name) {}

  static constexpr std::size_t least_bytes(Type type) { return size_of(type); }
  std::size_t bytes_left() const { return bytes_.size() - at_; }
  static std::int64_t place(std::uint64_t index) { return static_cast<std::int64_t>(index) + 1; }

  double real(Type type) {
    if (type == Type::f4) return take<float>();
    if (type == Type::f8) return take<double>();
    return static_cast<double>(integer(type));
  }
  std::int64_t integer(Type type) {
    switch (type) {
      case Type::i1:
        return take<std::int8_t>();
      case Type::u1:
        return take<std::uint8_t>();
      case Type::i2:
        return take<std::int16_t>();
      case Type::u2:
        return take<std::uint16_t>();
      case Type::i4:
        return take<std::int32_t>();
      case Type::u4:
        return take<std::uint32_t>();
      case Type::f4:
      case Type::f8:
        break;
    }
    throw DataError::at(name_, "expected an integer type for counts and indices, found float");
  }
  void skip(Type type) {
    need(size_of(type));
    at_ += size_of(type);
  }
  // Blanks, line ends and zeros may follow.
  void expect_end() const {
    if (bytes_.find_first_not_of(std::string_view(" \t\r\n\0", 5), at_) != std::string_view::npos)
      throw DataError::at(name_, "expected the end of the file, found {} more bytes", bytes_left());
  }
  [[noreturn]] void fail(std::string_view element, std::uint64_t index, const std::string& message) const {
    throw DataError::at(name_, "{} {}: {}", element, index + 1, message);
  }

 private:
  void need(std::size_t bytes) const {
    if (bytes > bytes_left()) throw DataError::at(name_, "expected more data, found the end of the file");
  }
  template <class T>
  T take() {
    need(sizeof(T));
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &bytes_[at_], sizeof(T));
    if (swap_) std::ranges::reverse(raw);
    at_ += sizeof(T);
    return std::bit_cast<T>(raw);
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool swap_;
  const std::string& name_;
};

template <class Body>
class BodyReader {
 public:
  BodyReader(const Header& header, const std::string& name, Body body)
      : header_(header), name_(name), body_(std::move(body)) {
    soup_.text = header.encoding == Encoding::ascii;
    const auto vertices = std::ranges::find(header.elements, std::string_view("vertex"), &Element::name);
    if (vertices != header.elements.end()) vertex_count_ = vertices->count;
    check_point_count(vertex_count_, name);
  }

  SurfaceSoup read();

 private:
  void check_count(const Element& element) const;
  void read_vertices(const Element& element);
  void read_faces(const Element& element);
  void read_face(const Element& element, const Property& indices, std::uint64_t index);
  std::uint64_t list_length(const Element& element, const Property& list, std::uint64_t index);
  void skip(const Element& element, const Property& property, std::uint64_t index);

  const Header& header_;
  const std::string& name_;
  Body body_;
  std::uint64_t vertex_count_ = 0;  // of the header; the faces may come before the vertices
  SurfaceSoup soup_;
  std::vector<Vertex> corners_;
  PolygonReader polygons_;
};

template <class Body>
SurfaceSoup BodyReader<Body>::read() {
  for (const Element& element : header_.elements) {
    check_count(element);
    if (element.name == "vertex") {
      read_vertices(element);
    } else if (element.name == "face") {
      read_faces(element);
    } else {
      // An element without properties has no bytes, whatever its count.
      for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
        for (const Property& property : element.properties) skip(element, property, i);
    }
  }
  body_.expect_end();
  polygons_.cut_concave(soup_);
  return std::move(soup_);
}

// Checks, before anything is allocated, that the rest of the file can hold this many items.
template <class Body>
void BodyReader<Body>::check_count(const Element& element) const {
  std::size_t bytes_each = 0;
  for (const Property& property : element.properties)
    bytes_each += Body::least_bytes(property.is_list ? property.count_type : property.type);
  const std::size_t most = bytes_each == 0 ? std::numeric_limits<std::size_t>::max() : body_.bytes_left() / bytes_each;
  if (element.count > most)
    throw DataError::at(name_, "expected at most {} elements {} in the rest of the file, found {} in its header", most,
                        quote_found(element.name), element.count);
}

template <class Body>
void BodyReader<Body>::read_vertices(const Element& element) {
  for (const char* axis : {"x", "y", "z"})
    if (const Property* found = element.find(axis); !found || found->is_list)
      throw DataError::at(name_, "expected a property {} of the vertices, found none in the header", axis);
  if (!soup_.points.empty()) throw DataError::at(name_, "expected one element 'vertex' in the header, found two");
  soup_.points.reserve(element.count);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    Vec3 point;
    for (const Property& property : element.properties) {
      if (property.name == "x")
        point.x = body_.real(property.type);
      else if (property.name == "y")
        point.y = body_.real(property.type);
      else if (property.name == "z")
        point.z = body_.real(property.type);
      else
        skip(element, property, i);
    }
    if (!is_place(point))
      body_.fail(element.name, i, fmt::format("expected coordinates up to {}, found others", largest_coordinate));
    soup_.points.push_back(point);
  }
}

template <class Body>
void BodyReader<Body>::read_faces(const Element& element) {
  const Property* indices = element.find("vertex_indices");
  if (!indices) indices = element.find("vertex_index");
  if (!indices || !indices->is_list || is_float(indices->type))
    throw DataError::at(name_, "expected a list of integers vertex_indices of the faces, found none in the header");
  soup_.triangles.reserve(element.count);
  for (std::uint64_t i = 0; i < element.count; ++i) read_face(element, *indices, i);
}

template <class Body>
void BodyReader<Body>::read_face(const Element& element, const Property& indices, std::uint64_t index) {
  const std::int64_t place = body_.place(index);
  for (const Property& property : element.properties) {
    if (&property != &indices) {
      skip(element, property, index);
      continue;
    }
    const std::uint64_t corner_count = list_length(element, property, index);
    if (corner_count < 3)
      body_.fail(element.name, index, fmt::format("expected three or more vertices, found {}", corner_count));
    corners_.clear();
    for (std::uint64_t i = 0; i < corner_count; ++i) {
      const std::int64_t vertex = body_.integer(property.type);
      if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= vertex_count_)
        body_.fail(element.name, index,
                   fmt::format("expected a vertex index below {}, found {}", vertex_count_, vertex));
      corners_.push_back(static_cast<Vertex>(vertex));
    }
    polygons_.append(soup_, corners_, 0, place);
  }
}

template <class Body>
std::uint64_t BodyReader<Body>::list_length(const Element& element, const Property& list, std::uint64_t index) {
  const std::int64_t length = body_.integer(list.count_type);
  const std::size_t most = body_.bytes_left() / Body::least_bytes(list.type);
  if (length < 0 || static_cast<std::uint64_t>(length) > most)
    body_.fail(element.name, index,
               fmt::format("expected a list that the rest of the file can hold, found a length of {}", length));
  return static_cast<std::uint64_t>(length);
}

template <class Body>
void BodyReader<Body>::skip(const Element& element, const Property& property, std::uint64_t index) {
  const std::uint64_t values = property.is_list ? list_length(element, property, index) : 1;
  for (std::uint64_t i = 0; i < values; ++i) body_.skip(property.type);
}

}  // namespace

bool looks_like_ply(std::string_view bytes) {
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

SurfaceSoup read_ply(std::string_view bytes, const std::string& name) {
  TextScanner scanner(bytes, name);
  const Header header = read_ply_header(scanner);
  if (header.encoding == Encoding::ascii) return BodyReader(header, name, AsciiBody(scanner)).read();
  const bool swap = (header.encoding == Encoding::big) == (std::endian::native == std::endian::little);
  return BodyReader(header, name, BinaryBody(bytes.substr(scanner.position()), swap, name)).read();
}

}  // namespace hexpipe::formats
