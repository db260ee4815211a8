#pragma once
// For libraries that print messages to standard output, where the bundle goes, and for processes of which one speaks
// for all.

#include <iostream>
#include <streambuf>

namespace hexpipe {

// While it lives, what goes to std::cout goes nowhere, which is no error. Bundles are written past std::cout.
class MutedCout {
 public:
  MutedCout() : buffer_(std::cout.rdbuf(&nowhere_)) {}
  ~MutedCout() { std::cout.rdbuf(buffer_); }
  MutedCout(const MutedCout&) = delete;
  MutedCout& operator=(const MutedCout&) = delete;

 private:
  class Nowhere : public std::streambuf {
    int_type overflow(int_type character) override { return traits_type::not_eof(character); }
  };

  Nowhere nowhere_;
  std::streambuf* buffer_;
};

}  // namespace hexpipe
