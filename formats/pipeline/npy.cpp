#include "formats/pipeline/npy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <charconv>

#include "common/run/error.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::pipeline {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

constexpr std::string_view npy_magic = "\x93NUMPY";
constexpr std::size_t preamble = 10;  // magic, version, length of the dictionary

// The text after `'key':` in the dictionary, from its first character that is no space.
std::string_view value_of(std::string_view dictionary, std::string_view key, std::string_view source) {
  const std::string quoted = fmt::format("'{}':", key);
  const std::size_t at = dictionary.find(quoted);
  if (at == std::string_view::npos) throw DataError::at(source, "expected '{}' in the array's header, found none", key);
  std::string_view value = dictionary.substr(at + quoted.size());
  value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  return value;
}

NpyType parse_type(std::string_view value, std::string_view source) {
  const std::size_t end = value.size() > 1 ? value.find('\'', 1) : std::string_view::npos;
  const std::string_view code = end == std::string_view::npos ? value : value.substr(1, end - 1);
  const bool known = code.size() == 3 && (code[0] == '<' || (code[0] == '|' && code[2] == '1')) &&
                     std::string_view("fiu").find(code[1]) != std::string_view::npos &&
                     std::string_view("1248").find(code[2]) != std::string_view::npos && code != "<f1" && code != "|f1";
  if (!known)
    throw DataError::at(source, "expected little-endian numbers (like '<i4'), found type {}",
                        formats::quote_found(code));
  return {code[1], code[2] - '0'};
}

std::vector<std::uint64_t> parse_shape(std::string_view value, std::string_view source) {
  std::vector<std::uint64_t> shape;
  const char* at = value.data();
  const char* const end = at + value.size();
  if (at == end || *at++ != '(') throw DataError::at(source, "expected a shape in the array's header");
  while (at != end && *at != ')') {
    if (*at == ' ' || *at == ',') {
      ++at;
      continue;
    }
    std::uint64_t length = 0;
    const auto parsed = std::from_chars(at, end, length);
    if (parsed.ec != std::errc()) throw DataError::at(source, "expected a shape in the array's header");
    shape.push_back(length);
    at = parsed.ptr;
  }
  if (at == end) throw DataError::at(source, "expected a shape in the array's header");
  return shape;
}

}  // namespace

std::string npy_header(const NpyHeader& header) {
  const std::string_view order = header.type.bytes == 1 ? "|" : "<";
  std::string shape = fmt::format("{}", fmt::join(header.shape, ", "));
  if (header.shape.size() == 1) shape += ",";
  std::string dictionary = fmt::format("{{'descr': '{}{}{}', 'fortran_order': False, 'shape': ({}), }}", order,
                                       header.type.kind, header.type.bytes, shape);
  const std::size_t unpadded = preamble + dictionary.size() + 1;
  dictionary.append((64 - unpadded % 64) % 64, ' ');
  dictionary += '\n';
  std::string bytes(npy_magic);
  bytes += '\x01';
  bytes += '\x00';
  bytes += static_cast<char>(dictionary.size() & 0xff);
  bytes += static_cast<char>(dictionary.size() >> 8);
  return bytes + dictionary;
}

std::size_t npy_header_size(std::string_view first_ten) {
  if (first_ten.size() < preamble || first_ten.substr(0, npy_magic.size()) != npy_magic || first_ten[6] != 1) return 0;
  return preamble + static_cast<unsigned char>(first_ten[8]) + 256u * static_cast<unsigned char>(first_ten[9]);
}

NpyHeader parse_npy_header(std::string_view header, std::string_view source) {
  const std::string_view dictionary = header.substr(preamble);
  NpyHeader parsed;
  parsed.type = parse_type(value_of(dictionary, "descr", source), source);
  parsed.shape = parse_shape(value_of(dictionary, "shape", source), source);
  const bool fortran = value_of(dictionary, "fortran_order", source).substr(0, 4) == "True";
  if (fortran && parsed.shape.size() > 1)
    throw DataError::at(source, "expected an array in C order, found Fortran order");
  return parsed;
}

}  // namespace hexpipe::pipeline
