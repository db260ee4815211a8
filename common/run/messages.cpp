#include "common/run/messages.hpp"

#include <atomic>
#include <cstdio>

namespace hexpipe {
namespace {

std::atomic<bool> silent{false};

}  // namespace

void print_message(const std::string& text) {
  if (silent) return;
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

void silence_messages(bool on) {
  silent = on;
}

}  // namespace hexpipe
