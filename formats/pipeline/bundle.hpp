#pragma once
// Reads and writes bundles: tar archives (pax) of .npy arrays and small JSON files. libarchive streams them; nothing
// seeks.

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/run/memory.hpp"
#include "formats/pipeline/npy.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/output.hpp"

struct archive;

namespace hexpipe::pipeline {

// With the function that frees it.
using ArchiveHandle = std::unique_ptr<archive, int (*)(archive*)>;

inline constexpr std::string_view bundle_format = "tar";
inline constexpr std::string_view compressed_bundle_format = "tar.zst";

bool is_bundle_format(std::string_view format);

// The text after the last dot of the file's name; "tar.zst" as a whole; empty if there is no dot.
std::string_view ending_of(std::string_view path);

// True when the first bytes are those of a tar archive, plain or compressed by zstd.
bool looks_like_bundle(formats::Input& input);

class BundleWriter {
 public:
  // The caller commits the output after close().
  BundleWriter(formats::Output& output, bool compress);
  BundleWriter(const BundleWriter&) = delete;  // libarchive holds its address
  BundleWriter& operator=(const BundleWriter&) = delete;
  ~BundleWriter();

  void begin_member(const std::string& name, std::uint64_t bytes);
  void write(const void* data, std::size_t bytes);
  void add_text(const std::string& name, std::string_view text);

  // T is a number, or an array of numbers (a row); the .npy shape is (n) or (n,columns).
  template <class T>
  void add_array(const std::string& name, const std::vector<T>& rows) {
    begin_rows<T>(name, rows.size());
    write(rows.data(), rows.size() * sizeof(T));
  }
  // Integers as rows of so many columns.
  void add_rows(const std::string& name, const std::vector<std::int32_t>& numbers, std::size_t columns);
  // Begins an array of `count` rows; their bytes have to be written next.
  template <class T>
  void begin_rows(const std::string& name, std::uint64_t count) {
    NpyHeader header{npy_type<typename NpyRow<T>::Number>(), {count}};
    if (NpyRow<T>::columns > 0) header.shape.push_back(NpyRow<T>::columns);
    begin_array(name, header, count * sizeof(T));
  }

  // Writes the end of the archive.
  void close();

 private:
  static long on_write(archive*, void* self, const void* data, std::size_t bytes);
  void begin_array(const std::string& name, const NpyHeader& header, std::uint64_t bytes);
  // After a call that did not succeed, throws the output's exception or libarchive's message.
  void check(bool succeeded) const;

  formats::Output& output_;
  // The exception that Output threw inside libarchive's callback.
  std::exception_ptr output_error_;
  bool abandoned_ = false;
  // Freed first: it calls back.
  ArchiveHandle archive_;
};

class BundleReader {
 public:
  explicit BundleReader(formats::Input& input);
  BundleReader(const BundleReader&) = delete;  // libarchive holds its address
  BundleReader& operator=(const BundleReader&) = delete;

  // Goes to the next member; false at the end. Throws DataError when the archive is cut off or damaged, a member is not
  // a plain file, its name is absolute or has "..", its size is missing, or there are more members than a bundle has.
  bool next();
  const std::string& name() const { return name_; }
  // The names of input and member, for messages.
  std::string where() const;
  std::uint64_t size() const { return size_; }

  // The current member as an array with the rows of T (see add_array). Converts integers of any width where they fit,
  // and f4 to f8. Throws DataError on a wrong shape, type, or number of bytes.
  template <class T>
  std::vector<T> read_array() {
    using Number = typename NpyRow<T>::Number;
    const NpyHeader header = begin_array(NpyRow<T>::columns);
    std::vector<T> rows;
    read_rows(
        header, npy_type<Number>(), sizeof(T), [&](std::size_t count) { reserve_in_huge_pages(rows, count); },
        [&](std::size_t count) {
          rows.resize(count);
          return static_cast<void*>(rows.data());
        });
    return rows;
  }
  // The current member as rows of integers, one after the other, of any number of columns that is among `columns`. The
  // second is the number that is there.
  std::pair<std::vector<std::int32_t>, std::size_t> read_rows_of(std::span<const std::uint64_t> columns);
  // The same as read_array a block at a time, for arrays that are larger than the memory: returns how many rows there
  // are; then read_next_rows reads `count` of them. Numbers must have exactly the type of T.
  template <class T>
  std::uint64_t begin_rows() {
    const NpyHeader header = begin_array(NpyRow<T>::columns);
    check_type(header, npy_type<typename NpyRow<T>::Number>());
    return header.shape[0];
  }
  template <class T>
  void read_next_rows(T* rows, std::size_t count) {
    read_bytes(rows, count * sizeof(T));
  }
  // Reads the current member's next bytes, at most `most`, and returns their number: 0 at its end.
  std::size_t read_some(char* bytes, std::size_t most);
  // The current member as text; throws DataError when larger than `limit`.
  std::string read_text(std::size_t limit = 64 << 20);
  // The current member's bytes. Memory grows with them, so that a member that only claims to be huge costs nothing.
  std::string read_bytes_as_they_come();
  // Copies the current member, unchanged, to another bundle.
  void copy_to(BundleWriter& writer);

 private:
  static long on_read(archive*, void* self, const void** data);
  // Reads exactly this many bytes of the current member.
  void read_bytes(void* data, std::size_t bytes);
  // Refuses an archive whose few bytes would fill memory or disk.
  void check_swelling() const;
  // Reads the array's header and checks its shape against the columns (0: one dimension) and the member's size.
  NpyHeader begin_array(std::uint64_t columns);
  NpyHeader begin_array(std::span<const std::uint64_t> columns);
  // Reads all rows and grows the destination by `resize` (new row count -> first byte) as data arrives, so that an
  // array that only claims to be huge costs nothing. Calls `reserve` with the whole count first.
  void read_rows(const NpyHeader& header, NpyType wanted, std::size_t row_bytes,
                 const std::function<void(std::size_t)>& reserve, const std::function<void*(std::size_t)>& resize);
  void check_type(const NpyHeader& header, NpyType wanted) const;
  [[noreturn]] void fail(const char* what) const;

  formats::Input& input_;
  std::exception_ptr input_error_;
  ArchiveHandle archive_;
  std::string name_;
  std::uint64_t size_ = 0;
  std::uint64_t left_ = 0;
  std::int64_t members_ = 0;
};

}  // namespace hexpipe::pipeline
