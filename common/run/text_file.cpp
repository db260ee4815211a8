#include "common/run/text_file.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "common/run/error.hpp"
#include "common/run/links.hpp"

namespace hexpipe {
namespace {

// A copy of the caller's own descriptor shares its place in the file with it: what either writes next comes behind.
std::FILE* open_to_write(const std::string& path) {
  const auto open_already = open_descriptor(path);
  if (!open_already) return std::fopen(path.c_str(), "we");
  const int copy = fcntl(*open_already, F_DUPFD_CLOEXEC, 0);
  return copy < 0 ? nullptr : fdopen(copy, "w");
}

}  // namespace

TextFile::TextFile(std::string path) : path_(std::move(path)) {
  file_.reset(open_to_write(path_));
  if (!file_) throw DataError::at(path_, "cannot write: {}", std::strerror(errno));
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
  if (error_ != 0) throw DataError::at(path_, "cannot write: {}", std::strerror(error_));
}

}  // namespace hexpipe
