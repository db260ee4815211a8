#pragma once
// What is fuzzed: every reader of the project behind one function that takes the bytes of a file. Bad bytes must end in
// a DataError and nothing else; good ones must be read again as the same from what our writer makes of them.

#include <span>
#include <string_view>

namespace hexpipe {

struct FuzzedReader {
  const char* name;  // of its folder in corpus/
  // Throws what the reader throws; calls std::abort() where a promise of the reader is broken.
  void (*read)(std::string_view bytes);
};

std::span<const FuzzedReader> fuzzed_readers();

// Null when there is none.
const FuzzedReader* find_fuzzed_reader(std::string_view name);

// False when the reader refuses the bytes as a reader may. Every other exception passes.
bool accepts(const FuzzedReader& reader, std::string_view bytes);

}  // namespace hexpipe
