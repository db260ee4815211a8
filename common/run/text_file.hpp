#pragma once
// A text beside the product, such as statistics or a log.

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace hexpipe {

class TextFile {
 public:
  // "-" is standard output. An existing file is replaced; a file that the caller has already open, such as /dev/stderr,
  // is continued. Throws DataError when it cannot be written.
  explicit TextFile(const std::string& path);

  // Writes at once, so that others can follow the file. After a failure nothing more is written.
  void write(std::string_view text);
  // Throws DataError when some text could not be written.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string name_;  // for messages
  std::unique_ptr<std::FILE, Close> file_;
  int error_ = 0;  // errno of the first failure
};

}  // namespace hexpipe
