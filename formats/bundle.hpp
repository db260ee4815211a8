#pragma once
// Bundles: tar archives (pax) of .npy arrays and small JSON files, streamed through libarchive, never sought.

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/input.hpp"
#include "formats/output.hpp"

struct archive;
struct archive_entry;

namespace hexpipe {

// True when the first bytes are those of a tar archive, plain or compressed by zstd.
bool looks_like_bundle(Input& input);

class BundleWriter {
 public:
  // The output stays the caller's, who commits it after close().
  BundleWriter(Output& output, bool compress);
  ~BundleWriter();

  void begin_member(const std::string& name, std::uint64_t bytes);
  void write(const void* data, std::size_t bytes);
  void add_text(const std::string& name, std::string_view text);

  // T is a number, or an array of numbers (a row); the .npy shape is (n) or (n,columns).
  template <class T>
  void add_array(const std::string& name, std::span<const T> rows);

  // Writes the end of the archive.
  void close();

 private:
  Output& output_;
  archive* archive_;
};

class BundleReader {
 public:
  explicit BundleReader(Input& input);
  ~BundleReader();
  BundleReader(const BundleReader&) = delete;
  BundleReader& operator=(const BundleReader&) = delete;

  // Goes to the next member; false at the end. Throws DataError when the archive is cut off or damaged, a member is no
  // plain file, its name is absolute or has "..", or its size is missing.
  bool next();
  const std::string& name() const { return name_; }
  // Input's name and member's name, for messages.
  std::string where() const;
  std::uint64_t size() const { return size_; }

  // The current member as an array with the rows of T (see add_array). Integers of any width are taken where they fit,
  // floats of any width as f8. Throws DataError on a wrong shape, type, or number of bytes.
  template <class T>
  std::vector<T> read_array();
  // The current member as text; throws DataError when larger than `limit`.
  std::string read_text(std::size_t limit = 64 << 20);
  // The current member's bytes, unchanged, to another bundle.
  void copy_to(BundleWriter& writer);

 private:
  static long on_read(archive*, void* self, const void** data);
  std::size_t read_bytes(void* data, std::size_t bytes);

  Input& input_;
  archive* archive_;
  std::string name_;
  std::uint64_t size_ = 0;
  std::uint64_t left_ = 0;
};

}  // namespace hexpipe
