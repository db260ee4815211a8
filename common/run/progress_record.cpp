#include "common/run/progress_record.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <string_view>

namespace hexpipe {
namespace {

// Shorter text is filled up with blanks.
using Record = std::array<char, 160>;

}  // namespace

std::optional<int> progress_record_of_parent() {
  const char* const text = std::getenv(progress_record_variable);
  if (text == nullptr) return std::nullopt;
  const std::string_view digits = text;
  int file = -1;
  const auto [end, error] = std::from_chars(digits.begin(), digits.end(), file);
  const bool is_number = error == std::errc() && end == digits.end() && file > STDERR_FILENO;
  return is_number && fcntl(file, F_GETFD) >= 0 ? std::optional(file) : std::nullopt;
}

void write_progress_record(int file, const std::string& text) {
  Record record;
  record.fill(' ');
  std::copy_n(text.begin(), std::min(text.size(), record.size()), record.begin());
  static_cast<void>(!pwrite(file, record.data(), record.size(), 0));
}

std::string read_progress_record(int file) {
  Record record;
  const ssize_t count = pread(file, record.data(), record.size(), 0);
  std::string text(record.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace hexpipe
