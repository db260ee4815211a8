#pragma once
// How the modules of libraries say what is wrong: in one message, before which the caller puts the file's name.

#include <sys/stat.h>

#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>

// A function of HDF5, on which all of these libraries stand. Not all of them need its headers.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int H5dont_atexit(void);

namespace hexpipe::formats {

// Call it first: after an error, the work of HDF5 at the end of a process fails, with messages or by a crash.
inline void leave_hdf5_out_at_exit() {
  static const int left_out = H5dont_atexit();
  static_cast<void>(left_out);
}

[[noreturn]] inline void fail(const std::string& reason) {
  throw std::runtime_error(reason);
}

[[noreturn]] inline void fail_expected(const std::string& what, const std::string& found) {
  fail("expected " + what + ", found " + found);
}
template <class Number>
[[noreturn]] void fail_expected(const std::string& what, Number found) {
  fail_expected(what, std::to_string(found));
}

// A file cannot hold more numbers than this: zlib makes at most 1032 bytes of one, and a number has 4.
inline std::uint64_t most_numbers_in(const std::string& path) {
  struct stat status {};
  stat(path.c_str(), &status);
  return static_cast<std::uint64_t>(status.st_size) * 1032 / 4;
}

// Libraries print each error in many lines, although they also return it. While this lives, they print nothing.
class QuietLibrary {
 public:
  QuietLibrary() : kept_(stderr), nowhere_(std::fopen("/dev/null", "w")) {
    leave_hdf5_out_at_exit();
    if (nowhere_ != nullptr) stderr = nowhere_;
  }
  ~QuietLibrary() {
    stderr = kept_;
    if (nowhere_ != nullptr) std::fclose(nowhere_);
  }
  QuietLibrary(const QuietLibrary&) = delete;
  QuietLibrary& operator=(const QuietLibrary&) = delete;

 private:
  std::FILE* kept_;
  std::FILE* nowhere_;
};

}  // namespace hexpipe::formats
