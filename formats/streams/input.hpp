#pragma once
// Bytes from a file or from standard input. A reader can look at them before it takes them; nothing seeks.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hexpipe::formats {

class Input {
 public:
  // Opens a file; "-" is standard input. Throws DataError when it cannot be opened or is a directory.
  static Input open(const std::string& path);
  // Bytes in memory, for tests.
  static Input from_memory(std::string bytes, std::string name);

  Input(Input&&) noexcept;
  Input& operator=(Input&&) noexcept;
  ~Input();

  // For messages: the path as given, or "stdin".
  const std::string& name() const { return name_; }
  // The path to look beside for companion files (TetGen's .ele); empty for standard input.
  const std::string& path() const { return path_; }

  // The next bytes without taking them: `count` of them, or fewer at the end. Throws DataError on a read error.
  std::string_view peek(std::size_t count);
  // Takes the bytes at hand, at most a buffer; empty at the end. Valid until the next call.
  std::string_view read_some();
  // Takes everything.
  std::string read_all();

 private:
  Input() = default;
  bool fill();

  std::string name_, path_;
  int descriptor_ = -1;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  bool at_end_ = false;
  bool may_wait_ = false;  // for another process
};

}  // namespace hexpipe::formats
