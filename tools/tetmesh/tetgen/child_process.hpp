#pragma once
// Work in a child process that may crash, hang or leak without harm to this one.

#include <sys/types.h>

#include <cstdint>
#include <functional>

namespace hexpipe::tetmesh::tetgen {

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
  int code = 0;        // exit code, or the signal that killed it
  double seconds = 0;  // of the processor
};

// `work` in a forked child on a thread of its own, with nothing under it that could catch an exception: one that
// escapes ends the child at once, without unwinding; an int is its exit code, anything else `uncaught_exception`. The
// child has no standard input, its outputs lead nowhere; it dies with this process, by a signal or otherwise. glibc
// makes fork() safe for malloc and stdio in the child even where other threads run here; the work must not use other
// threads of this process.
class ChildProcess {
 public:
  // Starts the work, which is ended after `timeout` seconds (infinity for never). Throws DataError when the system
  // gives no process.
  ChildProcess(const std::function<void()>& work, double timeout);
  // Kills it, unless it was waited for.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Once. Throws DataError when the system gave the child no thread.
  ChildEnd wait();

 private:
  pid_t child_;
};

constexpr int uncaught_exception = 118;

}  // namespace hexpipe::tetmesh::tetgen
