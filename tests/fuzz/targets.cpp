#include "tests/fuzz/targets.hpp"

#include <cstdio>
#include <cstdlib>

#include "common/run/error.hpp"

namespace hexpipe {

std::vector<FuzzTarget> fuzz_targets() {
  std::vector<FuzzTarget> targets;
  for (const auto& some : {reader_targets(), tool_targets()}) targets.insert(targets.end(), some.begin(), some.end());
#ifdef HEXPIPE_FUZZES_SURFACES
  for (const auto& target : surface_targets()) targets.push_back(target);
#endif
  return targets;
}

bool accepts(const FuzzTarget& target, std::string_view bytes) {
  try {
    target.run(bytes);
    return true;
  } catch (const DataError&) {
    return false;
  }
}

void promise(bool kept, std::string_view what) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

}  // namespace hexpipe
