#pragma once
// The output of a writer, as bytes.

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

#include "formats/streams/output.hpp"
#include "tests/unit/temporary_path.hpp"

namespace hexpipe::testing {
using namespace formats;

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
