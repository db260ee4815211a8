#pragma once
// Unpacks gzip on the way to an Input, and makes UTF-8 of UTF-16. The first bytes tell both.

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace hexpipe::formats {

// Puts bytes into the span, at least one unless the end is reached, and returns how many.
using ByteSource = std::function<std::size_t(std::span<char>)>;

class Decoder {
 public:
  virtual ~Decoder() = default;
  // As a ByteSource, from the packed bytes of `source`. Throws DataError where these are damaged or cut off.
  virtual std::size_t read(std::span<char> to, const ByteSource& source) = 0;
};

// As many bytes tell whether there is something to decode.
inline constexpr std::size_t bytes_that_tell_decoding = 4;

// The decoder for a file that begins with these bytes; null: the bytes are the content. The decoder begins with the
// bytes given here and goes on with those of the source. `name` is for messages.
std::unique_ptr<Decoder> decoder_for(std::string_view first_bytes, const std::string& name);

}  // namespace hexpipe::formats
