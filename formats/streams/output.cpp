#include "formats/streams/output.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/open_files.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/temporary_file.hpp"

namespace hexpipe::formats {
namespace {

constexpr int most_names_tried = 100;
// A pipe gets this much in one call of write(2): then a reader that takes 22 kB/s makes progress within the time that
// it has.
constexpr std::size_t most_before_wait = 1 << 16;

bool is_regular(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

bool is_regular_or_new(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode);
}

std::string directory_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

// The path under which the kernel shows an open file, so that the file can be given a name.
std::string link_of(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

// The permissions for the finished file: those of the file that it replaces, or those that the umask leaves.
mode_t mode_for(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) return status.st_mode & 07777;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

}  // namespace

Output::Output(const std::string& path) {
  if (path.empty() || path == "-") {
    name_ = "stdout";
    descriptor_ = STDOUT_FILENO;
    fcntl(descriptor_, F_SETPIPE_SZ, buffer_limit);
    may_wait_ = !is_regular(descriptor_);
    return;
  }
  name_ = path;
  if (const auto open_already = open_descriptor(path)) {
    descriptor_ = fcntl(*open_already, F_DUPFD_CLOEXEC, 0);
    if (descriptor_ < 0) fail();
    may_wait_ = !is_regular(descriptor_);
    return;
  }
  if (!is_regular_or_new(path)) {
    const WaitForReader wait;  // of a FIFO, to open it
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail();
    return;
  }
  // A rename ignores permissions, but a file that its owner has protected must not be replaced.
  if (access(path.c_str(), F_OK) == 0 && access(path.c_str(), W_OK) != 0) fail();
  may_wait_ = false;
  path_ = behind_links(path);
  open_beside();
  fchmod(descriptor_, mode_for(path_));
}

// Without a name where the file system can do that.
void Output::open_beside() {
  descriptor_ = ::open(directory_of(path_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (descriptor_ >= 0 && access(link_of(descriptor_).c_str(), F_OK) == 0) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  name_beside();
}

void Output::name_beside() {
  temporary_ = path_ + ".XXXXXX";
  descriptor_ = mkostemp(temporary_.data(), O_CLOEXEC);
  if (descriptor_ < 0) {
    temporary_.clear();
    fail();
  }
  removed_.set(temporary_.c_str());
}

void Output::fail() const {
  throw DataError::at(name_, "cannot write: {}", std::strerror(errno));
}

Output::~Output() {
  if (descriptor_ >= 0 && descriptor_ != STDOUT_FILENO) ::close(descriptor_);
  if (!committed_ && !temporary_.empty()) {
    unlink(temporary_.c_str());
    removed_.set("");
  }
}

void Output::write(std::string_view bytes) {
  if (buffer_.size() + bytes.size() < buffer_limit) {
    buffer_.append(bytes);
    return;
  }
  flush();
  write_through(bytes);
}

void Output::flush() {
  write_through(buffer_);
  buffer_.clear();
}

void Output::write_by_path(const std::function<void(const std::string& path)>& write_file) {
  if (path_.empty()) {
    const TemporaryFile file;
    write_file(file.path());
    return copy_file(file.path());
  }
  if (temporary_.empty()) {
    ::close(descriptor_);
    name_beside();
  }
  write_file(temporary_);
  // Some libraries remove the file that is there, and make another.
  const int written = ::open(temporary_.c_str(), O_WRONLY | O_CLOEXEC);
  if (written < 0) fail();
  ::close(std::exchange(descriptor_, written));
  fchmod(descriptor_, mode_for(path_));
}

void Output::copy_file(const std::string& path) {
  Input file = Input::open(path);
  for (std::string_view bytes = file.read_some(); !bytes.empty(); bytes = file.read_some()) write(bytes);
}

void Output::drain() {
  flush();
  buffer_.shrink_to_fit();
}

void Output::write_through(std::string_view bytes) {
  while (!bytes.empty()) {
    std::optional<WaitForReader> wait;
    if (may_wait_) wait.emplace();
    const ssize_t written =
        ::write(descriptor_, bytes.data(), may_wait_ ? std::min(bytes.size(), most_before_wait) : bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail();
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

// A link cannot replace a file, but a rename can: for a moment the new file is beside the old one.
void Output::put_in_place(int descriptor) {
  const std::string unnamed = link_of(descriptor);
  for (int attempt = 0; temporary_.empty(); ++attempt) {
    std::string name = fmt::format("{}.{}-{}", path_, getpid(), attempt);
    removed_.set(name.c_str());  // before the file exists, because a signal may come at once
    if (linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      temporary_ = std::move(name);  // which needs no memory
    } else {
      removed_.set("");
      if (errno != EEXIST || attempt == most_names_tried) fail();
    }
  }
  if (rename(temporary_.c_str(), path_.c_str()) != 0) fail();
}

void Output::commit() {
  flush();
  // Some file systems tell of a full disk only at the end: of a copy, so that the file can still be named.
  const int copy = path_.empty() ? -1 : dup(descriptor_);
  if (copy >= 0 && ::close(copy) != 0) fail();
  if (!path_.empty()) put_in_place(descriptor_);
  const int descriptor = descriptor_;
  descriptor_ = -1;
  const bool closed = ::close(descriptor) == 0;
  committed_ = true;
  removed_.set("");
  if (!closed && path_.empty()) fail();
}

}  // namespace hexpipe::formats
