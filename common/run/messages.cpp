#include "common/run/messages.hpp"

#include <cstdio>

namespace hexpipe {

void print_message(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace hexpipe
