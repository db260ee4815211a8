#pragma once
// The targets of fuzzing: every reader of the project and its whole tools, as functions of bytes.

#include <span>
#include <string_view>
#include <vector>

namespace hexpipe {

struct FuzzTarget {
  const char* name;  // of its folder in corpus/
  // Throws what the code throws; calls std::abort() where it breaks a promise.
  void (*run)(std::string_view bytes);
  // Where a tar archive begins in the bytes, whose arrays may be changed by themselves; -1 for no archive.
  int archive = -1;
};

// Bad bytes must end in a DataError and nothing else; good ones must be read again as the same from what our writer
// makes of them.
std::span<const FuzzTarget> reader_targets();
// Bad bytes must end in exit code 1 with a message and no output, good ones in 0 and an output that the next tool
// takes.
std::span<const FuzzTarget> tool_targets();
#ifdef HEXPIPE_FUZZES_SURFACES
// Bad bytes must end in a DataError; what passes for the boundary of a solid must be one, and what is made of it.
std::span<const FuzzTarget> surface_targets();
#endif

std::vector<FuzzTarget> fuzz_targets();

// False when the bytes are refused as they may be. Every other exception passes.
bool accepts(const FuzzTarget& target, std::string_view bytes);

// Prints what it is and aborts where a promise is not kept.
void promise(bool kept, std::string_view what);

}  // namespace hexpipe
