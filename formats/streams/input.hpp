#pragma once
// Bytes from a file or from standard input. A reader can look at them before it takes them; nothing seeks. gzip is
// unpacked on the way, and UTF-16 becomes UTF-8.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/streams/decoding.hpp"

namespace hexpipe::formats {

class Input {
 public:
  // Opens a file; "-" is standard input. Throws DataError when it cannot be opened or is a directory.
  static Input open(const std::string& path);
  // Bytes in memory, for tests, as if they were those of a file.
  static Input from_memory(std::string bytes, std::string name);

  Input(Input&&) noexcept;
  Input& operator=(Input&&) noexcept;
  ~Input();

  // For messages: the path as given, or "stdin".
  const std::string& name() const { return name_; }
  // The path to look beside for companion files (TetGen's .ele); empty for standard input.
  const std::string& path() const { return path_; }

  // Whether the bytes at the path are others: packed, or in UTF-16. It is known once a byte was read.
  bool is_decoded() const { return !decoders_.empty(); }

  // The next bytes without taking them: `count` of them, or fewer at the end. Throws DataError on a read error.
  std::string_view peek(std::size_t count);
  // Takes the bytes at hand, at most a buffer; empty at the end. Valid until the next call.
  std::string_view read_some();
  // Takes everything.
  std::string read_all();

 private:
  Input() = default;
  bool fill();
  void find_decoders();
  std::size_t read_through(std::size_t decoders, std::span<char> to);
  std::size_t read_bytes(std::span<char> to);

  std::string name_, path_;
  int descriptor_ = -1;  // of the file; otherwise the bytes are in `memory_`
  std::string memory_;
  std::size_t taken_ = 0;                           // of the memory
  std::vector<std::unique_ptr<Decoder>> decoders_;  // the first one reads the bytes of the file
  bool decoders_known_ = false;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  bool at_end_ = false;
  bool may_wait_ = false;  // for another process
};

}  // namespace hexpipe::formats
