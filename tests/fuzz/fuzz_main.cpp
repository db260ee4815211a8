// libFuzzer's entry: fuzz_readers --reader=NAME [CORPUS...] [-libFuzzer's options]. formats/README.md lists the
// readers.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/readers.hpp"

namespace {

const hexpipe::FuzzedReader* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  constexpr std::string_view option = "--reader=";
  for (int i = 1; i < *argc; ++i) {
    const std::string_view argument = (*argv)[i];
    if (argument.starts_with(option)) chosen = hexpipe::find_fuzzed_reader(argument.substr(option.size()));
  }
  if (chosen != nullptr) return 0;
  std::fprintf(stderr, "usage: fuzz_readers --reader=NAME [CORPUS...]; NAME is one of\n");
  for (const auto& reader : hexpipe::fuzzed_readers()) std::fprintf(stderr, "  %s\n", reader.name);
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hexpipe::accepts(*chosen, {reinterpret_cast<const char*>(data), size});
  return 0;
}
