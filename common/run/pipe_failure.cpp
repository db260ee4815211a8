#include "common/run/pipe_failure.hpp"

#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>

namespace hexpipe {
namespace {

std::atomic<std::int64_t> written{0}, read_count{0};
std::atomic<bool> stdin_ended{false}, stdout_broke{false};

// Nanoseconds that no clock gives by chance.
constexpr long writer_failed = 271828183, reader_failed = 314159265;

bool is_nameless_pipe(int descriptor) {
  constexpr long pipe_magic = 0x50495045;  // PIPEFS_MAGIC of linux/magic.h
  struct statfs system {};
  return fstatfs(descriptor, &system) == 0 && system.f_type == pipe_magic;
}

void mark(int descriptor, long which, std::int64_t bytes) {
  if (!is_nameless_pipe(descriptor)) return;
  const timespec kept{0, UTIME_OMIT}, marked{static_cast<time_t>(bytes), which};
  const timespec times[2] = {kept, marked};
  futimens(descriptor, times);
}

bool has_mark(int descriptor, long which, std::int64_t bytes) {
  struct stat status {};
  return is_nameless_pipe(descriptor) && fstat(descriptor, &status) == 0 && status.st_mtim.tv_nsec == which &&
         status.st_mtim.tv_sec == bytes;
}

}  // namespace

void count_written_to_stdout(std::size_t bytes) {
  written += static_cast<std::int64_t>(bytes);
}

void count_read_from_stdin(std::size_t bytes) {
  read_count += static_cast<std::int64_t>(bytes);
}

void note_end_of_stdin() {
  stdin_ended = true;
}

void note_broken_stdout() {
  stdout_broke = true;
}

void mark_pipes_as_failed() {
  mark(STDOUT_FILENO, writer_failed, written);
  // How much a reader took says nothing: some of what was written may be in the pipe still.
  mark(STDIN_FILENO, reader_failed, 0);
}

bool writer_has_failed() {
  return stdin_ended && has_mark(STDIN_FILENO, writer_failed, read_count);
}

bool reader_has_failed() {
  return stdout_broke && has_mark(STDOUT_FILENO, reader_failed, 0);
}

}  // namespace hexpipe
