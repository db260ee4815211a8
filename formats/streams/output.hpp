#pragma once
// Writes bytes to a file or to standard output. A file has no name until it is whole, so that a failure leaves the old
// file as it was, and even a kill leaves nothing else.

#include <fmt/format.h>

#include <cstddef>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "common/run/removed_files.hpp"

namespace hexpipe::formats {

class Output {
 public:
  // Empty or "-" is standard output. A path to something other than a regular file (/dev/full, a FIFO), or to something
  // that is open already (/dev/stdout), is written directly. Throws DataError when it cannot be written, or is a file
  // without permission to write.
  explicit Output(const std::string& path);
  // Removes what was written unless commit() was called.
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  const std::string& name() const { return name_; }
  // Whether it becomes a file of this name, rather than bytes in a pipe.
  bool is_named_file() const { return !path_.empty(); }
  // Throws DataError when the disk is full or the reader has gone.
  void write(std::string_view bytes);
  template <class... Args>
  void print(fmt::format_string<Args...> text, Args&&... args) {
    fmt::format_to(std::back_inserter(buffer_), text, std::forward<Args>(args)...);
    if (buffer_.size() >= buffer_limit) flush();
  }
  // For libraries that write a file by its path, and nothing else: `write_file` makes the file of this path, which is
  // in place of the output's own, or is copied where that is no new file. Throws DataError as write does.
  void write_by_path(const std::function<void(const std::string& path)>& write_file);
  // Writes the buffer and frees its memory: commit() may come much later. Throws DataError when the disk is full.
  void drain();
  // Ends the output: flushes, closes, puts the file in place. Throws DataError when any of it fails.
  void commit();

 private:
  static constexpr std::size_t buffer_limit = 1 << 20;
  void open_beside();
  void name_beside();
  void put_in_place(int descriptor);
  [[noreturn]] void fail() const;
  void flush();
  void write_through(std::string_view bytes);
  void copy_file(const std::string& path);

  std::string name_, path_;
  std::string temporary_;  // the file beside path_ while it has a name
  RemovedFile removed_;    // that file
  int descriptor_ = -1;
  bool may_wait_ = true;  // for a reader, because it is not a file
  std::string buffer_;
  bool committed_ = false;
};

}  // namespace hexpipe::formats
