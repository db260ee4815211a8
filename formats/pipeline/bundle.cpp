#include "formats/pipeline/bundle.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <new>
#include <type_traits>
#include <utility>

#include "common/run/error.hpp"
#include "common/run/memory.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::pipeline {
namespace {

constexpr std::size_t tar_block = 512;
constexpr std::size_t rows_chunk_bytes = 4 << 20;
// More than any pipeline makes, far less than what fills a disk.
constexpr std::int64_t most_members = 10'000;
// Zeros compressed by zstd swell by 32768. Bundles, which hold coordinates, do so by less than 20.
constexpr std::int64_t most_swelling = 1000, swelling_judged_from = 64 << 20;
// The longest name that tar held before pax.
constexpr std::size_t longest_name = 255;
constexpr std::string_view zstd_magic = "\x28\xb5\x2f\xfd";

struct EntryDeleter {
  void operator()(archive_entry* entry) const { archive_entry_free(entry); }
};

using EntryPointer = std::unique_ptr<archive_entry, EntryDeleter>;

EntryPointer new_entry() {
  EntryPointer entry(archive_entry_new());
  if (!entry) throw std::bad_alloc();
  return entry;
}

// Names appear in messages and go on to other programs.
bool is_printable_name(std::string_view name) {
  const bool printable = std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
  return printable && name.size() <= longest_name;
}

bool is_safe_name(std::string_view name) {
  if (name.empty() || name.front() == '/') return false;
  while (true) {
    const std::size_t slash = name.find('/');
    if (name.substr(0, slash) == "..") return false;
    if (slash == std::string_view::npos) return true;
    name.remove_prefix(slash + 1);
  }
}

// Converts numbers of one type into another, if each one fits; false at the first that does not.
template <class From, class To>
bool convert(const char* from, To* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    From value;
    std::memcpy(&value, from + i * sizeof(From), sizeof(From));
    if constexpr (std::is_integral_v<From> && std::is_integral_v<To>)
      if (!std::in_range<To>(value)) return false;
    to[i] = static_cast<To>(value);  // NOLINT(bugprone-signed-char-misuse): a number, not a character
  }
  return true;
}

template <class To>
bool convert_to(NpyType from, const char* data, To* to, std::size_t count) {
  switch (from.kind == 'f' ? 100 + from.bytes : from.kind == 'u' ? 10 + from.bytes : from.bytes) {
    case 1:
      return convert<std::int8_t>(data, to, count);
    case 2:
      return convert<std::int16_t>(data, to, count);
    case 4:
      return convert<std::int32_t>(data, to, count);
    case 8:
      return convert<std::int64_t>(data, to, count);
    case 11:
      return convert<std::uint8_t>(data, to, count);
    case 12:
      return convert<std::uint16_t>(data, to, count);
    case 14:
      return convert<std::uint32_t>(data, to, count);
    case 18:
      return convert<std::uint64_t>(data, to, count);
    case 104:
      return convert<float>(data, to, count);
    case 108:
      return convert<double>(data, to, count);
    default:
      return false;
  }
}

// Only the types that bundles hold are destinations.
bool convert_numbers(NpyType from, const char* data, NpyType to, void* destination, std::size_t count) {
  if (to == NpyType{'f', 8}) return convert_to(from, data, static_cast<double*>(destination), count);
  if (to == NpyType{'i', 4}) return convert_to(from, data, static_cast<std::int32_t*>(destination), count);
  if (to == NpyType{'i', 8}) return convert_to(from, data, static_cast<std::int64_t*>(destination), count);
  if (to == NpyType{'i', 1}) return convert_to(from, data, static_cast<std::int8_t*>(destination), count);
  if (to == NpyType{'u', 8}) return convert_to(from, data, static_cast<std::uint64_t*>(destination), count);
  return convert_to(from, data, static_cast<std::uint8_t*>(destination), count);
}

}  // namespace

bool is_bundle_format(std::string_view format) {
  return format == bundle_format || format == compressed_bundle_format;
}

std::string_view ending_of(std::string_view path) {
  path = path.substr(path.rfind('/') + 1);
  if (path.ends_with(".tar.zst")) return compressed_bundle_format;
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? std::string_view() : path.substr(dot + 1);
}

bool looks_like_bundle(formats::Input& input) {
  const std::string_view start = input.peek(tar_block);
  return start.substr(0, zstd_magic.size()) == zstd_magic || (start.size() >= 262 && start.substr(257, 5) == "ustar");
}

// ---- writing

BundleWriter::BundleWriter(formats::Output& output, bool compress)
    : output_(output), archive_(archive_write_new(), &archive_write_free) {
  if (!archive_) throw std::bad_alloc();
  archive_write_set_format_pax_restricted(archive_.get());
  if (compress) archive_write_add_filter_zstd(archive_.get());
  // Output has a buffer; none here, so that arrays go through without a copy.
  archive_write_set_bytes_per_block(archive_.get(), 0);
  archive_write_set_bytes_in_last_block(archive_.get(), 1);
  check(archive_write_open(archive_.get(), this, nullptr, &BundleWriter::on_write, nullptr) == ARCHIVE_OK);
}

// libarchive closes a writer that it frees, which would write the end of the archive: a failed one must not look
// complete.
BundleWriter::~BundleWriter() {
  abandoned_ = true;
}

// Never fails as far as libarchive can see: no exception may cross it, and it does not free a writer that has failed.
long BundleWriter::on_write(archive*, void* self, const void* data, std::size_t bytes) {
  auto* const writer = static_cast<BundleWriter*>(self);
  if (writer->abandoned_ || writer->output_error_) return static_cast<long>(bytes);
  try {
    writer->output_.write({static_cast<const char*>(data), bytes});
  } catch (...) {
    writer->output_error_ = std::current_exception();
  }
  return static_cast<long>(bytes);
}

void BundleWriter::check(bool succeeded) const {
  if (output_error_) std::rethrow_exception(output_error_);
  if (succeeded) return;
  const char* const reason = archive_error_string(archive_.get());
  throw DataError::at(output_.name(), "cannot write the bundle: {}", reason ? reason : "part of it is missing");
}

void BundleWriter::begin_member(const std::string& name, std::uint64_t bytes) {
  const EntryPointer entry = new_entry();
  archive_entry_set_pathname(entry.get(), name.c_str());
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0644);
  archive_entry_set_mtime(entry.get(), 0, 0);
  check(archive_write_header(archive_.get(), entry.get()) == ARCHIVE_OK);
}

void BundleWriter::write(const void* data, std::size_t bytes) {
  // libarchive takes less than 2 GiB at once.
  constexpr std::size_t most_at_once = 1 << 30;
  for (const char* at = static_cast<const char*>(data); bytes > 0;) {
    const std::size_t now = std::min(bytes, most_at_once);
    check(archive_write_data(archive_.get(), at, now) == static_cast<la_ssize_t>(now));
    at += now;
    bytes -= now;
  }
}

void BundleWriter::add_text(const std::string& name, std::string_view text) {
  begin_member(name, text.size());
  write(text.data(), text.size());
}

void BundleWriter::begin_array(const std::string& name, const NpyHeader& header, std::uint64_t bytes) {
  const std::string start = npy_header(header);
  begin_member(name, start.size() + bytes);
  write(start.data(), start.size());
}

void BundleWriter::add_rows(const std::string& name, const std::vector<std::int32_t>& numbers, std::size_t columns) {
  begin_array(name, {npy_type<std::int32_t>(), {numbers.size() / columns, columns}},
              numbers.size() * sizeof(std::int32_t));
  write(numbers.data(), numbers.size() * sizeof(std::int32_t));
}

void BundleWriter::close() {
  check(archive_write_close(archive_.get()) == ARCHIVE_OK);
}

// ---- reading

BundleReader::BundleReader(formats::Input& input) : input_(input), archive_(archive_read_new(), &archive_read_free) {
  if (!archive_) throw std::bad_alloc();
  archive_read_support_format_tar(archive_.get());
  archive_read_support_filter_zstd(archive_.get());
  // archive_read_open() is the same without looking whether there was memory for it.
  archive_read_set_read_callback(archive_.get(), &BundleReader::on_read);
  if (archive_read_set_callback_data(archive_.get(), this) != ARCHIVE_OK) throw std::bad_alloc();
  if (archive_read_open1(archive_.get()) != ARCHIVE_OK) fail("expected a bundle");
}

long BundleReader::on_read(archive* handle, void* self, const void** data) {
  auto* const reader = static_cast<BundleReader*>(self);
  try {
    const std::string_view bytes = reader->input_.read_some();
    *data = bytes.data();
    return static_cast<long>(bytes.size());
  } catch (...) {
    reader->input_error_ = std::current_exception();
    archive_set_error(handle, EIO, "input failed");
    return ARCHIVE_FATAL;
  }
}

void BundleReader::fail(const char* what) const {
  if (input_error_) std::rethrow_exception(input_error_);
  const char* const reason = archive_error_string(archive_.get());
  throw DataError::at(name_.empty() ? input_.name() : where(), "{}, found: {}", what,
                      reason ? reason : "the end of the input");
}

std::string BundleReader::where() const {
  return fmt::format("{}: {}", input_.name(), name_);
}

bool BundleReader::next() {
  // Also takes the padding after a member that was read, so that the count below stands at the next header.
  if (!name_.empty()) archive_read_data_skip(archive_.get());
  // libarchive takes the end of the input between two members for the end of the archive. Ours ends with blocks of
  // zeros.
  const la_int64_t before = archive_filter_bytes(archive_.get(), 0);
  // An entry of our own, because libarchive does not check whether there was memory for its own.
  const EntryPointer owner = new_entry();
  archive_entry* const entry = owner.get();
  const int result = archive_read_next_header2(archive_.get(), entry);
  if (result == ARCHIVE_EOF) {
    const la_int64_t after = archive_filter_bytes(archive_.get(), 0);
    if (after - before < static_cast<la_int64_t>(tar_block))
      throw DataError::at(input_.name(), "expected the end of the bundle{}, found the end of the input: it is cut off",
                          name_.empty() ? "" : " after " + name_);
    return false;
  }
  if (result != ARCHIVE_OK) fail("expected the next member of the bundle");
  const char* const path = archive_entry_pathname(entry);
  const std::string name = path ? path : "";
  if (!is_printable_name(name))
    throw DataError::at(input_.name(), "expected a member name of at most {} printable ASCII characters, found {}",
                        longest_name, formats::quote_found(name));
  if (!is_safe_name(name))
    throw DataError::at(input_.name(), "expected a relative member name without '..', found '{}'", name);
  name_ = name;
  if (archive_entry_filetype(entry) != AE_IFREG || archive_entry_hardlink(entry) || !archive_entry_size_is_set(entry))
    throw DataError::at(where(), "expected a plain file in the bundle, found a link, directory or device");
  // Its holes would be read as endless zeros.
  if (archive_entry_sparse_count(entry) > 0)
    throw DataError::at(where(), "expected a plain file in the bundle, found one with holes");
  if (++members_ > most_members)
    throw DataError::at(input_.name(), "expected a bundle of at most {} members, found more", most_members);
  size_ = left_ = static_cast<std::uint64_t>(archive_entry_size(entry));
  return true;
}

void BundleReader::read_bytes(void* data, std::size_t bytes) {
  auto* at = static_cast<char*>(data);
  while (bytes > 0) {
    const la_ssize_t got = archive_read_data(archive_.get(), at, bytes);
    if (got <= 0) fail("expected the rest of the member");
    check_swelling();
    at += got;
    bytes -= static_cast<std::size_t>(got);
    left_ -= static_cast<std::uint64_t>(got);
  }
}

void BundleReader::check_swelling() const {
  const la_int64_t whole = archive_filter_bytes(archive_.get(), 0), packed = archive_filter_bytes(archive_.get(), -1);
  if (whole > swelling_judged_from && whole / most_swelling > packed)
    throw DataError::at(where(), "expected a bundle that is compressed by less than {} to 1, found {} bytes out of {}",
                        most_swelling, whole, packed);
}

NpyHeader BundleReader::begin_array(std::uint64_t columns) {
  return begin_array(std::span(&columns, 1));
}

std::pair<std::vector<std::int32_t>, std::size_t> BundleReader::read_rows_of(std::span<const std::uint64_t> columns) {
  const NpyHeader header = begin_array(columns);
  const std::size_t width = header.shape[1];
  std::vector<std::int32_t> numbers;
  read_rows(
      header, npy_type<std::int32_t>(), width * sizeof(std::int32_t),
      [&](std::size_t rows) { reserve_in_huge_pages(numbers, rows * width); },
      [&](std::size_t rows) {
        numbers.resize(rows * width);
        return static_cast<void*>(numbers.data());
      });
  return {std::move(numbers), width};
}

NpyHeader BundleReader::begin_array(std::span<const std::uint64_t> columns) {
  std::string header(10, '\0');
  if (size_ < header.size()) throw DataError::at(where(), "expected a .npy array, found {} bytes", size_);
  read_bytes(header.data(), header.size());
  const std::size_t header_size = npy_header_size(header);
  if (header_size == 0 || header_size > size_) throw DataError::at(where(), "expected a .npy array of version 1.0");
  header.resize(header_size);
  read_bytes(header.data() + 10, header_size - 10);
  NpyHeader parsed = parse_npy_header(header, where());

  const auto fits = [&](std::uint64_t wanted) {
    return wanted == 0 ? parsed.shape.size() == 1 : parsed.shape.size() == 2 && parsed.shape[1] == wanted;
  };
  const auto found = std::ranges::find_if(columns, fits);
  if (found == columns.end()) {
    std::vector<std::string> shapes;
    for (const std::uint64_t wanted : columns) shapes.push_back(wanted == 0 ? "(n)" : fmt::format("(n,{})", wanted));
    throw DataError::at(where(), "expected an array of shape {}, found ({})", fmt::join(shapes, " or "),
                        fmt::join(parsed.shape, ","));
  }
  const std::uint64_t row_bytes = std::max<std::uint64_t>(*found, 1) * static_cast<std::uint64_t>(parsed.type.bytes);
  if (parsed.shape[0] > left_ / row_bytes || parsed.shape[0] * row_bytes != left_)
    throw DataError::at(where(), "expected {} rows of {} bytes, found {} bytes", parsed.shape[0], row_bytes, left_);
  return parsed;
}

void BundleReader::read_rows(const NpyHeader& header, NpyType wanted, std::size_t row_bytes,
                             const std::function<void(std::size_t)>& reserve,
                             const std::function<void*(std::size_t)>& resize) {
  const bool is_half = header.type == NpyType{'f', 2};
  if ((header.type.kind == 'f') != (wanted.kind == 'f') || is_half)
    throw DataError::at(where(), "expected numbers of type {}{}, found {}{}", wanted.kind, wanted.bytes,
                        header.type.kind, header.type.bytes);
  const std::size_t count = header.shape[0];
  expect_memory(count, row_bytes, where());
  reserve(count);

  const std::size_t numbers_a_row = row_bytes / static_cast<std::size_t>(wanted.bytes);
  const std::size_t source_row_bytes = numbers_a_row * static_cast<std::size_t>(header.type.bytes);
  const std::size_t chunk = std::max<std::size_t>(rows_chunk_bytes / row_bytes, 1);
  std::vector<char> staging;
  for (std::size_t done = 0; done < count;) {
    const std::size_t rows = std::min(chunk, count - done);
    auto* const destination = static_cast<char*>(resize(done + rows)) + done * row_bytes;
    if (header.type == wanted) {
      read_bytes(destination, rows * row_bytes);
    } else {
      staging.resize(rows * source_row_bytes);
      read_bytes(staging.data(), staging.size());
      if (!convert_numbers(header.type, staging.data(), wanted, destination, rows * numbers_a_row))
        throw DataError::at(where(), "expected numbers that fit {} bytes, found a larger one", wanted.bytes);
    }
    done += rows;
  }
}

std::size_t BundleReader::read_some(char* bytes, std::size_t most) {
  const std::size_t count = std::min<std::uint64_t>(most, left_);
  read_bytes(bytes, count);
  return count;
}

void BundleReader::check_type(const NpyHeader& header, NpyType wanted) const {
  if (header.type != wanted)
    throw DataError::at(where(), "expected numbers of type {}{}, found {}{}", wanted.kind, wanted.bytes,
                        header.type.kind, header.type.bytes);
}

std::string BundleReader::read_text(std::size_t limit) {
  if (size_ > limit) throw DataError::at(where(), "expected at most {} bytes, found {}", limit, size_);
  std::string text(size_, '\0');
  read_bytes(text.data(), text.size());
  return text;
}

std::string BundleReader::read_bytes_as_they_come() {
  std::string bytes;
  std::vector<char> chunk(std::min<std::uint64_t>(size_, 1 << 20));
  while (const std::size_t count = read_some(chunk.data(), chunk.size())) bytes.append(chunk.data(), count);
  return bytes;
}

void BundleReader::copy_to(BundleWriter& writer) {
  writer.begin_member(name_, size_);
  std::vector<char> chunk(std::min<std::uint64_t>(size_, 1 << 20));
  while (const std::size_t bytes = read_some(chunk.data(), chunk.size())) writer.write(chunk.data(), bytes);
}

}  // namespace hexpipe::pipeline
