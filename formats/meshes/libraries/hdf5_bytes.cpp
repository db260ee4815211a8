#include "formats/meshes/libraries/hdf5_bytes.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "formats/meshes/libraries/library_errors.hpp"

namespace hexpipe::formats {
namespace {

using Bytes = std::span<unsigned char>;

std::uint32_t word_at(Bytes bytes) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4 && i < bytes.size(); ++i) word |= std::uint32_t{bytes[i]} << (8 * i);
  return word;
}

// Bob Jenkins' lookup3 (hashlittle), the checksum of HDF5's metadata.
std::uint32_t checksum(Bytes bytes) {
  std::uint32_t a = 0xdeadbeef + static_cast<std::uint32_t>(bytes.size()), b = a, c = a;
  while (bytes.size() > 12) {
    a += word_at(bytes), b += word_at(bytes.subspan(4)), c += word_at(bytes.subspan(8));
    a -= c, a ^= std::rotl(c, 4), c += b;
    b -= a, b ^= std::rotl(a, 6), a += c;
    c -= b, c ^= std::rotl(b, 8), b += a;
    a -= c, a ^= std::rotl(c, 16), c += b;
    b -= a, b ^= std::rotl(a, 19), a += c;
    c -= b, c ^= std::rotl(b, 4), b += a;
    bytes = bytes.subspan(12);
  }
  if (bytes.empty()) return c;
  a += word_at(bytes);
  if (bytes.size() > 4) b += word_at(bytes.subspan(4));
  if (bytes.size() > 8) c += word_at(bytes.subspan(8));
  c ^= b, c -= std::rotl(b, 14);
  a ^= c, a -= std::rotl(c, 11);
  b ^= a, b -= std::rotl(a, 25);
  c ^= b, c -= std::rotl(b, 16);
  a ^= c, a -= std::rotl(c, 4);
  b ^= a, b -= std::rotl(a, 14);
  c ^= b, c -= std::rotl(b, 24);
  return c;
}

std::uint64_t number_at(Bytes bytes, std::size_t width) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < width && i < bytes.size(); ++i) number |= std::uint64_t{bytes[i]} << (8 * i);
  return number;
}

// A chunk of a header: what its checksum stands for, which follows it.
struct Chunk {
  Bytes bytes;
  Bytes sum;

  bool is_right() const { return checksum(bytes) == word_at(sum); }
  void set_sum() const {
    const std::uint32_t value = checksum(bytes);
    for (std::size_t i = 0; i < 4; ++i) sum[i] = static_cast<unsigned char>(value >> (8 * i));
  }
};

// Headers of objects, of version 2. The first chunk: OHDR, version, flags, four times, two numbers of attributes, the
// size of the messages, messages, checksum. Others: OCHK, messages, checksum; a message of the chunk before tells
// where. Bytes of data that look like a header have another checksum.
class ObjectHeader {
 public:
  ObjectHeader(Bytes file, std::size_t at) : file_(file), header_(file.subspan(at)) {}

  void clear() {
    if (header_.size() < before_times || header_[4] != 2) return;
    flags_ = header_[5];
    const bool has_times = (flags_ & 0x20) != 0;
    std::size_t at = before_times + (has_times ? size_of_times : 0) + ((flags_ & 0x10) != 0 ? 4 : 0);
    const std::size_t width = std::size_t{1} << (flags_ & 3);
    if (header_.size() < at + width) return;
    const std::uint64_t size = number_at(header_.subspan(at), width);
    at += width;
    if (header_.size() - at < 4 || size > header_.size() - at - 4) return;
    const std::size_t end = at + static_cast<std::size_t>(size);
    const Chunk chunk{header_.first(end), header_.subspan(end, 4)};
    if (!chunk.is_right()) return;
    if (has_times) std::memset(header_.data() + before_times, 0, size_of_times);
    clear_messages(chunk.bytes.subspan(at));
    chunk.set_sum();
  }

 private:
  static constexpr std::size_t before_times = 6, size_of_times = 16;
  static constexpr unsigned attribute = 0x0c, continuation = 0x10;

  // Each: type, size, flags, place in the order of creation where there is one, data.
  void clear_messages(Bytes messages) {
    const std::size_t head = (flags_ & 4) != 0 ? 6 : 4;
    while (messages.size() > head) {
      const unsigned type = messages[0];
      const auto size = static_cast<std::size_t>(number_at(messages.subspan(1), 2));
      if (size > messages.size() - head) return;
      const Bytes data = messages.subspan(head, size);
      if (type == attribute) clear_text(data);
      if (type == continuation && size >= 16) clear_chunk(number_at(data, 8), number_at(data.subspan(8), 8));
      messages = messages.subspan(head + size);
    }
  }

  void clear_chunk(std::uint64_t at, std::uint64_t size) {
    if (at > file_.size() || size > file_.size() - at || size < 8) return;
    const Bytes all = file_.subspan(static_cast<std::size_t>(at), static_cast<std::size_t>(size));
    const Chunk chunk{all.first(all.size() - 4), all.last(4)};
    if (std::memcmp(all.data(), "OCHK", 4) != 0 || !chunk.is_right()) return;
    clear_messages(chunk.bytes.subspan(4));
    chunk.set_sum();
  }

  // Version, flags, sizes of name, type and space, encoding; these; the data. Behind the end of a text in a field,
  // CGNS' library writes what lay in its memory.
  static void clear_text(Bytes data) {
    if (data.size() < 9 || data[0] != 3) return;
    const std::uint64_t name = number_at(data.subspan(2), 2), type = number_at(data.subspan(4), 2),
                        space = number_at(data.subspan(6), 2);
    if (type < 8 || 9 + name + type + space > data.size()) return;
    const Bytes datatype = data.subspan(static_cast<std::size_t>(9 + name));
    constexpr unsigned fixed_text = 3;
    const bool ends_with_null = (datatype[1] & 0x0f) == 0;
    if ((datatype[0] & 0x0f) != fixed_text || !ends_with_null) return;
    const Bytes text = data.subspan(static_cast<std::size_t>(9 + name + type + space));
    if (text.size() != word_at(datatype.subspan(4))) return;  // several texts
    std::fill(std::find(text.begin(), text.end(), 0), text.end(), static_cast<unsigned char>(0));
  }

  Bytes file_, header_;
  unsigned flags_ = 0;
};

}  // namespace

void clear_hdf5_traces(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  struct stat status {};
  if (file < 0 || fstat(file, &status) != 0) fail(std::strerror(errno));
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const start = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  if (start == MAP_FAILED) fail(std::strerror(errno));
  const Bytes bytes(static_cast<unsigned char*>(start), size);
  const std::string_view text(static_cast<const char*>(start), size);
  for (std::size_t at = text.find("OHDR"); at != std::string_view::npos; at = text.find("OHDR", at + 1))
    ObjectHeader(bytes, at).clear();
  munmap(start, size);
}

}  // namespace hexpipe::formats
