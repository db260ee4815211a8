#include "formats/streams/input.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/pipe_failure.hpp"

namespace hexpipe::formats {
namespace {

constexpr std::size_t buffer_size = 1 << 20;

}  // namespace

Input Input::open(const std::string& path) {
  Input input;
  if (path == "-") {
    input.name_ = "stdin";
    input.descriptor_ = dup(STDIN_FILENO);
  } else {
    input.name_ = input.path_ = path;
    const WaitForInput wait;  // for the writer of a FIFO
    input.descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  }
  if (input.descriptor_ < 0) throw DataError::at(input.name_, "cannot open: {}", std::strerror(errno));
  struct stat status {};
  if (fstat(input.descriptor_, &status) == 0 && S_ISDIR(status.st_mode))
    throw DataError::at(input.name_, "expected a file, found a directory");
  input.may_wait_ = !S_ISREG(status.st_mode);
  // A larger pipe means fewer switches between the stages; if it is refused, the default serves.
  if (S_ISFIFO(status.st_mode)) fcntl(input.descriptor_, F_SETPIPE_SZ, buffer_size);
  if (S_ISFIFO(status.st_mode) && path == "-") leave_interrupt_upstream(true);
  input.buffer_.resize(buffer_size);
  return input;
}

Input Input::from_memory(std::string bytes, std::string name) {
  Input input;
  input.name_ = std::move(name);
  input.memory_ = std::move(bytes);
  input.buffer_.resize(input.memory_.size() + bytes_that_tell_decoding);
  return input;
}

Input::Input(Input&& other) noexcept {
  *this = std::move(other);
}

Input& Input::operator=(Input&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(memory_, other.memory_);
  std::swap(taken_, other.taken_);
  std::swap(decoders_, other.decoders_);
  std::swap(decoders_known_, other.decoders_known_);
  std::swap(buffer_, other.buffer_);
  std::swap(begin_, other.begin_);
  std::swap(end_, other.end_);
  std::swap(at_end_, other.at_end_);
  std::swap(may_wait_, other.may_wait_);
  return *this;
}

Input::~Input() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (path_.empty()) leave_interrupt_upstream(false);
}

// Reads the first bytes, and puts those that are no sign of a code into the buffer. A packed text may be UTF-16.
void Input::find_decoders() {
  constexpr std::size_t most = 2;
  decoders_known_ = true;
  for (;;) {
    char first[bytes_that_tell_decoding];
    std::size_t count = 0;
    while (count < sizeof first) {
      const std::size_t got = read_through(decoders_.size(), std::span(first).subspan(count));
      if (got == 0) break;
      count += got;
    }
    const std::string_view bytes(first, count);
    auto decoder = decoders_.size() < most ? decoder_for(bytes, name_) : nullptr;
    if (decoder == nullptr) {
      end_ = static_cast<std::size_t>(std::ranges::copy(bytes, buffer_.begin()).out - buffer_.begin());
      return;
    }
    decoders_.push_back(std::move(decoder));
  }
}

// Reads what the first `decoders` of them make of the file.
std::size_t Input::read_through(std::size_t decoders, std::span<char> to) {
  if (decoders == 0) return read_bytes(to);
  return decoders_[decoders - 1]->read(to, [&](std::span<char> packed) { return read_through(decoders - 1, packed); });
}

std::size_t Input::read_bytes(std::span<char> to) {
  if (descriptor_ < 0) {
    const std::size_t count = std::min(to.size(), memory_.size() - taken_);
    std::copy_n(memory_.data() + taken_, count, to.data());
    taken_ += count;
    return count;
  }
  std::optional<WaitForInput> wait;
  if (may_wait_) wait.emplace();
  ssize_t got;
  do got = ::read(descriptor_, to.data(), to.size());
  while (got < 0 && errno == EINTR);
  if (got < 0) throw DataError::at(name_, "cannot read: {}", std::strerror(errno));
  if (path_.empty()) {
    count_read_from_stdin(static_cast<std::size_t>(got));
    if (got == 0) note_end_of_stdin();
    if (got == 0) leave_interrupt_upstream(false);
  }
  return static_cast<std::size_t>(got);
}

// Appends bytes to those at hand, at least one unless the end is reached. The buffer must have room.
bool Input::fill() {
  if (at_end_) return false;
  if (!decoders_known_) {  // the buffer is empty
    find_decoders();
    if (end_ > 0) return true;
  }
  const std::size_t got = read_through(decoders_.size(), std::span(buffer_).subspan(end_));
  at_end_ = got == 0;
  end_ += got;
  return got > 0;
}

std::string_view Input::peek(std::size_t count) {
  if (begin_ + count > buffer_.size()) {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
              buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= begin_;
    begin_ = 0;
    buffer_.resize(std::max(buffer_.size(), count));
  }
  while (end_ - begin_ < count && fill()) {
  }
  return {buffer_.data() + begin_, std::min(count, end_ - begin_)};
}

std::string_view Input::read_some() {
  if (begin_ == end_) {
    if (at_end_) return {};
    begin_ = end_ = 0;
    fill();
  }
  const std::string_view bytes(buffer_.data() + begin_, end_ - begin_);
  begin_ = end_;
  return bytes;
}

std::string Input::read_all() {
  std::string all;
  struct stat status {};
  if (descriptor_ >= 0 && fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode))
    all.reserve(static_cast<std::size_t>(status.st_size) + 1);
  for (std::string_view bytes = read_some(); !bytes.empty(); bytes = read_some()) all.append(bytes);
  return all;
}

}  // namespace hexpipe::formats
