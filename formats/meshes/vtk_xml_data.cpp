#include "formats/meshes/vtk_xml_data.hpp"

#include <zlib.h>

#include <array>
#include <vector>

#include "common/run/error.hpp"
#include "formats/streams/scalar_bytes.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

constexpr int no_digit = -1;

constexpr std::array<int, 256> base64_values() {
  std::array<int, 256> values{};
  values.fill(no_digit);
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < digits.size(); ++i) values[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
  return values;
}
constexpr auto base64_value = base64_values();

bool is_space(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

std::uint64_t take_header_number(EncodedBytes& bytes, const VtkXmlEncoding& encoding, std::string_view where) {
  const ScalarType type = encoding.long_header ? ScalarType::uint64 : ScalarType::uint32;
  return convert_scalars<std::uint64_t>(bytes.take(size_of(type)), type, encoding.order, where).front();
}

std::string inflate_blocks(EncodedBytes& bytes, const VtkXmlEncoding& encoding, std::string_view where) {
  const std::uint64_t blocks = take_header_number(bytes, encoding, where);
  if (blocks > bytes.most_left()) throw DataError::at(where, "expected {} compressed blocks, found fewer", blocks);
  const std::uint64_t block_size = take_header_number(bytes, encoding, where);
  const std::uint64_t last_size = take_header_number(bytes, encoding, where);
  std::vector<std::uint64_t> compressed_sizes;
  for (std::uint64_t i = 0; i < blocks; ++i) compressed_sizes.push_back(take_header_number(bytes, encoding, where));

  std::string data;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    const std::uint64_t size = i + 1 == blocks && last_size != 0 ? last_size : block_size;
    const std::string_view compressed = bytes.take(compressed_sizes[i]);
    // Deflate shrinks nothing by more than 1032 to 1.
    if (size > 1032 * (compressed.size() + 1))
      throw DataError::at(where, "expected {} bytes out of {} compressed ones, which is impossible", size,
                          compressed.size());
    const std::size_t begin = data.size();
    data.resize(begin + size);
    uLongf got = size;
    const int status = uncompress(reinterpret_cast<Bytef*>(data.data() + begin), &got,
                                  reinterpret_cast<const Bytef*>(compressed.data()), compressed.size());
    if (status != Z_OK || got != size)
      throw DataError::at(where, "expected a block of {} bytes compressed by zlib, found damaged data", size);
  }
  return data;
}

}  // namespace

std::uint64_t EncodedBytes::most_left() const {
  return base64_ ? decoded_.size() - used_ + (text_.size() + 3) / 4 * 3 : text_.size();
}

// Four digits are three bytes; the last group of a piece has one or two '=' in place of digits.
void EncodedBytes::decode_group() {
  std::uint32_t bits = 0;
  int digits = 0, padding = 0;
  while (digits + padding < 4) {
    if (text_.empty()) throw DataError::at(where_, "expected base64, found its end");
    const char c = text_.front();
    text_.remove_prefix(1);
    if (is_space(c)) continue;
    const int value = base64_value[static_cast<unsigned char>(c)];
    const bool pads = c == '=' && digits >= 2;
    if (!pads && (value == no_digit || padding > 0))
      throw DataError::at(where_, "expected base64, found {}", quote_found({&c, 1}));
    bits = bits << 6 | static_cast<std::uint32_t>(pads ? 0 : value);
    ++(pads ? padding : digits);
  }
  for (int i = 0; i < digits - 1; ++i) decoded_.push_back(static_cast<char>(bits >> (16 - 8 * i) & 0xff));
}

std::string_view EncodedBytes::take(std::uint64_t count) {
  if (count > most_left()) throw DataError::at(where_, "expected {} bytes, found at most {}", count, most_left());
  if (!base64_) {
    const std::string_view taken = text_.substr(0, count);
    text_.remove_prefix(count);
    return taken;
  }
  decoded_.erase(0, used_);
  used_ = count;
  decoded_.reserve(count + 2);
  while (decoded_.size() < count) decode_group();
  return std::string_view(decoded_).substr(0, count);
}

std::string_view read_vtk_xml_data(EncodedBytes& bytes, const VtkXmlEncoding& encoding, std::string_view where,
                                   std::string& storage) {
  if (!encoding.compressed) return bytes.take(take_header_number(bytes, encoding, where));
  storage = inflate_blocks(bytes, encoding, where);
  return storage;
}

}  // namespace hexpipe::formats
