#pragma once
// Work in a child process that may crash, hang or leak without harm to this one.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace hexpipe {

// Where the child leaves its result: memory that both processes share, which grows as it is written.
class SharedResult {
 public:
  SharedResult();
  ~SharedResult();
  SharedResult(const SharedResult&) = delete;
  SharedResult& operator=(const SharedResult&) = delete;

  // In the child: appends bytes. Ends the child with `write_failed` when there is no memory.
  void append(const void* data, std::size_t bytes);
  // In the parent: takes bytes from the front. Throws DataError when the child left fewer.
  void take(void* data, std::size_t bytes);

  static constexpr int write_failed = 119;

 private:
  int descriptor_;
  std::uint64_t taken_ = 0;
};

struct ChildEnd {
  enum class Kind { exited, killed, timed_out } kind = Kind::exited;
  int code = 0;      // exit code, or the signal that killed it
  std::string said;  // the last of what it printed, on either stream
};

// Runs `work` in a forked child on a thread of its own, with nothing under it that could catch an exception: one that
// escapes ends the child at once, without unwinding; an int is its exit code, anything else `uncaught`. The child has
// no standard input, its outputs are caught; it dies with this process, by a signal or otherwise. It is killed after
// `timeout` seconds (infinity for none). glibc makes fork() safe for malloc and stdio in the child even where other
// threads run here; the work must not use other threads of this process.
// Throws DataError when the system gives no process, pipe or thread.
ChildEnd run_in_child(const std::function<void()>& work, double timeout);

constexpr int uncaught_exception = 118;

}  // namespace hexpipe
