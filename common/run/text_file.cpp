#include "common/run/text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include "common/run/error.hpp"
#include "common/run/open_files.hpp"

namespace hexpipe {
namespace {

// A duplicate of the caller's descriptor shares the position in the file, so the texts of both follow each other.
std::FILE* open_to_write(const std::string& path) {
  const std::optional<int> open_already = path == "-" ? STDOUT_FILENO : open_descriptor(path);
  if (!open_already) return std::fopen(path.c_str(), "we");
  const int copy = fcntl(*open_already, F_DUPFD_CLOEXEC, 0);
  return copy < 0 ? nullptr : fdopen(copy, "w");
}

}  // namespace

TextFile::TextFile(const std::string& path) : name_(path == "-" ? "stdout" : path), file_(open_to_write(path)) {
  if (!file_) throw DataError::at(name_, "cannot write: {}", std::strerror(errno));
}

void TextFile::write(std::string_view text) {
  if (error_ != 0) return;
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0)
    error_ = errno;
}

void TextFile::close() {
  errno = 0;
  if (std::fclose(file_.release()) != 0 && error_ == 0) error_ = errno;
  if (error_ != 0) throw DataError::at(name_, "cannot write: {}", std::strerror(error_));
}

}  // namespace hexpipe
