#include "tools/viewmesh/options.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "common/run/error.hpp"

namespace hexpipe::viewmesh {

void check(const ViewmeshOptions& options) {
  // -o picture.png is easily typed, and would write a page under the name of a picture.
  if (options.page.ends_with(".png"))
    throw UsageError(
        fmt::format("-o writes a page: expected another name than '{0}' (a picture: --png {0})", options.page));
  if (options.picture.ends_with(".html") || options.picture.ends_with(".htm"))
    throw UsageError(
        fmt::format("--png writes a picture: expected another name than '{0}' (a page: -o {0})", options.picture));
  if (options.page.empty() && options.picture.empty() && isatty(STDOUT_FILENO))
    throw UsageError("standard output is a terminal: write the page to a file with -o, or a picture with --png");
}

}  // namespace hexpipe::viewmesh
