#pragma once
// Bytes to a file or to standard output. A file is written without a name and put in place when it is whole, so that a
// failure leaves the old file as it was, and even a kill leaves nothing else.

#include <fmt/format.h>

#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "common/run/removed_files.hpp"

namespace hexpipe::formats {

class Output {
 public:
  // Empty or "-" is standard output. A path to something that is no regular file (/dev/full, a FIFO), or to what is
  // open already (/dev/stdout), is written directly. Throws DataError when it cannot be written, a file that may not be
  // too.
  explicit Output(const std::string& path);
  // Without commit(), nothing is left of what was written.
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  const std::string& name() const { return name_; }
  // Throws DataError when the disk is full or the reader has gone.
  void write(std::string_view bytes);
  template <class... Args>
  void print(fmt::format_string<Args...> text, Args&&... args) {
    fmt::format_to(std::back_inserter(buffer_), text, std::forward<Args>(args)...);
    if (buffer_.size() >= buffer_limit) flush();
  }
  // Keeps no memory until commit(), which may come much later. Throws DataError when the disk is full.
  void drain();
  // Everything is written: flush, close, put in place. Throws DataError when any of it fails.
  void commit();

 private:
  static constexpr std::size_t buffer_limit = 1 << 20;
  void open_beside();
  void put_in_place(int descriptor);
  [[noreturn]] void fail() const;
  void flush();
  void write_through(std::string_view bytes);

  std::string name_, path_;
  std::string temporary_;  // the file beside path_ while it has a name
  RemovedFile removed_;    // that file
  int descriptor_ = -1;
  bool may_wait_ = true;  // for a reader: it is no file
  std::string buffer_;
  bool committed_ = false;
};

}  // namespace hexpipe::formats
