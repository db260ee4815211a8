#pragma once
// The output of a writer, as bytes; and names for the files that tests make.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

#include "formats/streams/output.hpp"

namespace hexpipe::testing {
using namespace formats;

// A path of this process alone: ctest runs several tests of an executable at the same time.
inline std::string temporary_path(const std::string& name) {
  return ::testing::TempDir() + std::to_string(getpid()) + "-" + name;
}

inline std::string read_file(const std::string& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

// `write` is given an Output.
template <class Write>
std::string written_bytes(Write&& write) {
  const std::string path = temporary_path("written");
  {
    Output output(path);
    write(output);
    output.commit();
  }
  std::string bytes = read_file(path);
  std::remove(path.c_str());
  return bytes;
}

}  // namespace hexpipe::testing
