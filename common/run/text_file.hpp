#pragma once
// A text beside the product, as statistics and logs are.

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace hexpipe {

class TextFile {
 public:
  // "-" is standard output. Replaces what is there; goes on behind it where the caller has the file open already, as
  // /dev/stderr. Throws DataError where it cannot be written.
  explicit TextFile(const std::string& path);

  // At once, so that others can follow it. Nothing more is written after a failure.
  void write(std::string_view text);
  // Throws DataError when something could not be written.
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
