#include "formats/streams/zip_archive.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <new>

#include "common/run/error.hpp"

namespace hexpipe::formats {
namespace {

constexpr std::size_t most_unpacked_bytes = std::size_t{1} << 31;
constexpr std::size_t usual_swelling = 250, harmless_bytes = std::size_t{1} << 28;

struct ArchiveEnd {
  void operator()(archive* a) const { archive_read_free(a); }
};

}  // namespace

std::vector<std::pair<std::string, std::string>> unpack_zip(std::string_view bytes, const std::string& name,
                                                            std::string_view kind,
                                                            const std::function<bool(std::string_view)>& is_wanted) {
  const std::unique_ptr<archive, ArchiveEnd> zip(archive_read_new());
  if (!zip) throw std::bad_alloc();
  const auto fail = [&]() {
    const char* said = archive_error_string(zip.get());
    throw DataError::at(name, "expected {} that is whole, found a damaged zip archive: {}", kind,
                        said ? said : "no entry");
  };
  archive_read_support_format_zip(zip.get());
  if (archive_read_open_memory(zip.get(), bytes.data(), bytes.size()) != ARCHIVE_OK) fail();
  const std::size_t most = std::min(most_unpacked_bytes, std::max(harmless_bytes, usual_swelling * bytes.size()));
  std::vector<std::pair<std::string, std::string>> files;
  std::size_t total = 0;
  std::array<char, 1 << 16> chunk;
  for (archive_entry* entry = nullptr;;) {
    const int result = archive_read_next_header(zip.get(), &entry);
    if (result == ARCHIVE_EOF) return files;
    if (result < ARCHIVE_WARN) fail();
    const char* const path = archive_entry_pathname(entry);
    const std::string_view name_in_zip = path ? path : "";
    if (!is_wanted(name_in_zip)) continue;
    auto& [file, text] = files.emplace_back(name_in_zip, std::string());
    for (;;) {
      const la_ssize_t got = archive_read_data(zip.get(), chunk.data(), chunk.size());
      if (got < 0) fail();
      if (got == 0) break;
      text.append(chunk.data(), static_cast<std::size_t>(got));
      if ((total += static_cast<std::size_t>(got)) > most)
        throw DataError::at(name, "expected at most {} bytes in {}, found more", most, kind);
    }
  }
}

}  // namespace hexpipe::formats
