// libFuzzer's entry: fuzz --target=NAME [CORPUS...] [-libFuzzer's options]. README.md lists the targets.

#include <signal.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "common/run/random.hpp"
#include "tests/fuzz/tar_members.hpp"
#include "tests/fuzz/targets.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t largest);

namespace {

hexpipe::FuzzTarget chosen{};
volatile std::sig_atomic_t time_is_over = 0;

std::string_view text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  constexpr std::string_view option = "--target=";
  signal(SIGXCPU, [](int) { time_is_over = 1; });
  const auto targets = hexpipe::fuzz_targets();
  for (int i = 1; i < *argc; ++i) {
    const std::string_view argument = (*argv)[i];
    if (!argument.starts_with(option)) continue;
    const auto found = std::ranges::find(targets, argument.substr(option.size()), &hexpipe::FuzzTarget::name);
    if (found != targets.end()) chosen = *found;
  }
  if (chosen.run != nullptr) return 0;
  std::fprintf(stderr, "usage: fuzz --target=NAME [CORPUS...]; NAME is one of\n");
  for (const auto& target : targets) std::fprintf(stderr, "  %s\n", target.name);
  std::exit(2);
}

// Every other mutation of an archive changes numbers in its arrays.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t largest,
                                               unsigned seed) {
  hexpipe::Random random(seed);
  if (chosen.archive < 0 || size < static_cast<std::size_t>(chosen.archive) || random.below(2) == 0)
    return LLVMFuzzerMutate(data, size, largest);
  const std::string changed = hexpipe::with_changed_numbers(text(data, size).substr(chosen.archive), random);
  std::ranges::copy(changed, data + chosen.archive);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // At the limit of processor time libFuzzer ends with its figures, as when it is interrupted. Tools have handlers of
  // their own while they run.
  if (time_is_over != 0) raise(SIGINT);
  hexpipe::accepts(chosen, text(data, size));
  return 0;
}
