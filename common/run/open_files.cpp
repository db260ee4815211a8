#include "common/run/open_files.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <charconv>
#include <string_view>

namespace hexpipe {
namespace {

std::optional<int> descriptor_in(std::string_view path) {
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!path.starts_with(folder)) continue;
    const char* const end = path.data() + path.size();
    int descriptor = 0;
    const auto [rest, error] = std::from_chars(path.data() + folder.size(), end, descriptor);
    if (error == std::errc{} && rest == end && descriptor >= 0) return descriptor;
  }
  return std::nullopt;
}

}  // namespace

std::string behind_links(std::string path) {
  char target[4096];
  for (int depth = 0; depth < 40 && !descriptor_in(path); ++depth) {
    const ssize_t length = readlink(path.c_str(), target, sizeof target);
    if (length < 0) break;
    const std::string next(target, static_cast<std::size_t>(length));
    const std::size_t slash = path.rfind('/');
    path.erase(next.front() == '/' || slash == std::string::npos ? 0 : slash + 1);
    path += next;
  }
  return path;
}

std::optional<int> open_descriptor(const std::string& path) {
  return descriptor_in(behind_links(path));
}

void allow_many_open_files() {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace hexpipe
