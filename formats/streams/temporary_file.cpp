#include "formats/streams/temporary_file.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "common/run/error.hpp"

namespace hexpipe::formats {
namespace {

void write_all(int descriptor, std::string_view bytes, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int reason = errno;
      ::close(descriptor);
      unlink(path.c_str());
      throw DataError::at(path, "cannot write: {}", std::strerror(reason));
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

TemporaryFile::TemporaryFile() : TemporaryFile(std::string_view()) {}

TemporaryFile::TemporaryFile(std::string_view bytes) {
  std::error_code error;
  path_ = (std::filesystem::temp_directory_path(error) / "hexpipe-XXXXXX").string();
  const int descriptor = mkostemp(path_.data(), O_CLOEXEC);
  if (descriptor < 0) throw DataError::at(path_, "cannot write: {}", std::strerror(errno));
  removed_.set(path_.c_str());
  write_all(descriptor, bytes, path_);
  ::close(descriptor);
}

TemporaryFile::~TemporaryFile() {
  unlink(path_.c_str());
}

}  // namespace hexpipe::formats
