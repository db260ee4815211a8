#pragma once
// For libraries that print messages to standard output, where the bundle goes.

#include <iostream>
#include <streambuf>

namespace hexpipe {

// While it lives, what goes to std::cout goes nowhere. Bundles are written past std::cout.
class MutedCout {
 public:
  MutedCout() : buffer_(std::cout.rdbuf(nullptr)) {}
  ~MutedCout() { std::cout.rdbuf(buffer_); }
  MutedCout(const MutedCout&) = delete;
  MutedCout& operator=(const MutedCout&) = delete;

 private:
  std::streambuf* buffer_;
};

}  // namespace hexpipe
