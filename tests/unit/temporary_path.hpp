#pragma once
// Names for the files that tests make.

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

namespace hexpipe::testing {

// A path of this process alone: ctest runs several tests of an executable at the same time.
inline std::string temporary_path(const std::string& name) {
  return ::testing::TempDir() + std::to_string(getpid()) + "-" + name;
}

}  // namespace hexpipe::testing
