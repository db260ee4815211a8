#pragma once
// Work in a child process that may crash, hang or leak without harm to this process.

#include <sys/types.h>

#include <cstdint>
#include <functional>

namespace hexpipe::tetmesh::tetgen {

// The child writes its result here: memory that both processes share, and that grows as it is written.
class SharedResult {
 public:
  SharedResult();
  ~SharedResult();
  SharedResult(const SharedResult&) = delete;
  SharedResult& operator=(const SharedResult&) = delete;

  // Called in the child: appends bytes. Ends the child with `write_failed` if there is no memory.
  void append(const void* data, std::size_t bytes);
  // Called in the parent: takes bytes from the front. Throws DataError if the child left fewer.
  void take(void* data, std::size_t bytes);

  static constexpr int write_failed = 119;

 private:
  int descriptor_;
  std::uint64_t taken_ = 0;
};

struct ChildEnd {
  enum class Kind { exited, killed, timed_out } kind = Kind::exited;
  int code = 0;        // the exit code, or the number of the signal that killed it
  double seconds = 0;  // processor time
};

// Runs `work` in a forked child, on a thread of its own where nothing can catch an exception. An exception that escapes
// ends the child at once, without unwinding: an int becomes the exit code, anything else gives `uncaught_exception`.
// The child has no standard input, and its outputs are discarded. It dies with this process, however this process ends.
// glibc makes fork() safe for malloc and stdio in the child even if other threads run here; the work must not use other
// threads of this process.
class ChildProcess {
 public:
  // Starts the work and ends it after `timeout` seconds (infinity: never). Throws DataError if the system gives no
  // process.
  ChildProcess(const std::function<void()>& work, double timeout);
  // Kills the child unless wait() was called.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // May be called once. Throws DataError if the system gave the child no thread.
  ChildEnd wait();

 private:
  pid_t child_;
};

constexpr int uncaught_exception = 118;

}  // namespace hexpipe::tetmesh::tetgen
