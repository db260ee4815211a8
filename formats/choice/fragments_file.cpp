#include "formats/choice/fragments_file.hpp"

#include "common/run/error.hpp"

namespace hexpipe::formats {

void FragmentsFile::add(std::span<const std::uint64_t> vertices) {
  if (failure_) return;
  try {
    const char* separator = "";
    for (const std::uint64_t v : vertices) {
      output_.print("{}{}", separator, v + 1);
      separator = " ";
    }
    output_.print("\n");
  } catch (const DataError&) {
    failure_ = std::current_exception();
  }
}

void FragmentsFile::commit() {
  if (failure_) std::rethrow_exception(failure_);
  output_.commit();
}

}  // namespace hexpipe::formats
