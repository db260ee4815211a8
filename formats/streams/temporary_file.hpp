#pragma once
// A file with a name, for libraries that read and write by path.

#include <string>
#include <string_view>

#include "common/run/removed_files.hpp"

namespace hexpipe::formats {

class TemporaryFile {
 public:
  // Empty, in the directory for such files ($TMPDIR). Throws DataError.
  TemporaryFile();
  explicit TemporaryFile(std::string_view bytes);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  RemovedFile removed_;
};

}  // namespace hexpipe::formats
