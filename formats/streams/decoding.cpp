#include "formats/streams/decoding.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <utility>

#include "common/run/error.hpp"

namespace hexpipe::formats {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t chunk_bytes = 1 << 16;

// zlib packs at most 1032 bytes into one. Surfaces and meshes give 3 to 30, also those of plain grids; zeros as a
// binary VTU has them come with other arrays. A file beyond both limits would only fill the memory.
constexpr std::uint64_t harmless_bytes = std::uint64_t{1} << 28, most_unpacked_of_packed = 250;

class Gunzip final : public Decoder {
 public:
  Gunzip(std::string_view first, std::string name) : name_(std::move(name)), packed_(first) {
    constexpr int largest_window = 15, gzip_only = 16;
    if (inflateInit2(&stream_, largest_window + gzip_only) != Z_OK) throw std::bad_alloc();
    given_ = packed_.size();
    point_at_packed();
  }
  Gunzip(const Gunzip&) = delete;
  Gunzip& operator=(const Gunzip&) = delete;
  ~Gunzip() override { inflateEnd(&stream_); }

  std::size_t read(std::span<char> to, const ByteSource& source) override {
    stream_.next_out = reinterpret_cast<Bytef*>(to.data());
    stream_.avail_out = static_cast<uInt>(std::min<std::size_t>(to.size(), 1u << 30));
    const uInt room = stream_.avail_out;
    while (stream_.avail_out == room) {
      if (stream_.avail_in == 0 && !refill(source)) {
        if (between_members_) return 0;
        throw DataError::at(name_, "expected the rest of a gzip file, found its end; is it cut off?");
      }
      if (between_members_ && !begin_member()) continue;
      inflate_some();
    }
    const std::size_t count = room - stream_.avail_out;
    unpacked_ += count;
    if (unpacked_ > harmless_bytes && unpacked_ / most_unpacked_of_packed > given_)
      throw DataError::at(name_, "expected at most {} bytes for each packed one, found more; gunzip it if it is right",
                          most_unpacked_of_packed);
    return count;
  }

 private:
  bool refill(const ByteSource& source) {
    packed_.resize(chunk_bytes);
    packed_.resize(source(packed_));
    given_ += packed_.size();
    point_at_packed();
    return !packed_.empty();
  }

  void point_at_packed() {
    stream_.next_in = reinterpret_cast<Bytef*>(packed_.data());
    stream_.avail_in = static_cast<uInt>(packed_.size());
  }

  // Members follow each other where files were put together; tapes fill up with zeros.
  bool begin_member() {
    if (*stream_.next_in == 0) {
      ++stream_.next_in;
      --stream_.avail_in;
      return false;
    }
    if (*stream_.next_in != 0x1f) throw DataError::at(name_, "expected the end of a gzip file, found other bytes");
    inflateReset(&stream_);
    between_members_ = false;
    return true;
  }

  void inflate_some() {
    switch (inflate(&stream_, Z_NO_FLUSH)) {
      case Z_STREAM_END:
        between_members_ = true;
        break;
      case Z_OK:
      case Z_BUF_ERROR:  // it needs more bytes
        break;
      case Z_MEM_ERROR:
        throw std::bad_alloc();
      default:
        throw DataError::at(name_, "expected a whole gzip file, found a damaged one: {}",
                            stream_.msg != nullptr ? stream_.msg : "it needs a dictionary");
    }
  }

  std::string name_, packed_;
  z_stream stream_{};
  std::uint64_t given_ = 0, unpacked_ = 0;
  bool between_members_ = false;
};

class Utf16 final : public Decoder {
 public:
  // `first` begins with the byte order mark.
  Utf16(std::string_view first, std::string name)
      : name_(std::move(name)), little_(first[0] == '\xff'), raw_(first.substr(2)) {}

  std::size_t read(std::span<char> to, const ByteSource& source) override {
    while (taken_ == text_.size()) {
      text_.clear();
      taken_ = 0;
      if (ended_) return 0;
      decode();
      if (text_.empty()) refill(source);
    }
    const std::size_t count = std::min(to.size(), text_.size() - taken_);
    std::copy_n(text_.data() + taken_, count, to.data());
    taken_ += count;
    return count;
  }

 private:
  void refill(const ByteSource& source) {
    const std::size_t kept = raw_.size();  // one byte at most
    raw_.resize(kept + chunk_bytes);
    const std::size_t got = source(std::span(raw_).subspan(kept));
    raw_.resize(kept + got);
    if (got > 0) return;
    if (kept > 0)
      throw DataError::at(name_, "expected UTF-16 of two bytes a letter, found an odd number of bytes; is it cut off?");
    ended_ = true;
    if (high_ != 0) append(replacement);
    high_ = 0;
  }

  // All whole units at hand.
  void decode() {
    std::size_t at = 0;
    for (; at + 1 < raw_.size(); at += 2) {
      const auto a = static_cast<unsigned char>(raw_[at]), b = static_cast<unsigned char>(raw_[at + 1]);
      take_unit(little_ ? static_cast<std::uint32_t>(a | b << 8) : static_cast<std::uint32_t>(a << 8 | b));
    }
    raw_.erase(0, at);
  }

  void take_unit(std::uint32_t unit) {
    const bool is_low = unit >= 0xdc00 && unit < 0xe000;
    if (high_ != 0) {
      const std::uint32_t high = std::exchange(high_, 0);
      if (is_low) return append(0x10000 + ((high - 0xd800) << 10) + (unit - 0xdc00));
      append(replacement);
    }
    if (unit >= 0xd800 && unit < 0xdc00)
      high_ = unit;
    else
      append(is_low ? replacement : unit);
  }

  void append(std::uint32_t code) {
    const auto put = [&](std::uint32_t byte) { text_.push_back(static_cast<char>(byte)); };
    if (code < 0x80) return put(code);
    if (code < 0x800) {
      put(0xc0 | code >> 6);
    } else if (code < 0x10000) {
      put(0xe0 | code >> 12);
      put(0x80 | (code >> 6 & 0x3f));
    } else {
      put(0xf0 | code >> 18);
      put(0x80 | (code >> 12 & 0x3f));
      put(0x80 | (code >> 6 & 0x3f));
    }
    put(0x80 | (code & 0x3f));
  }

  static constexpr std::uint32_t replacement = 0xfffd;  // for half a pair

  std::string name_;
  bool little_;
  std::string raw_, text_;
  std::size_t taken_ = 0;   // of the text
  std::uint32_t high_ = 0;  // the first half of a pair, or 0
  bool ended_ = false;
};

// The mark, and then a letter of ASCII, with which all our texts begin: a binary file may begin with the mark's bytes.
bool looks_like_utf16(std::string_view bytes) {
  const bool little = bytes.starts_with("\xff\xfe"sv);
  if (!little && !bytes.starts_with("\xfe\xff"sv)) return false;
  if (bytes.size() <= 3) return true;  // no binary file of ours is as short
  const auto low = static_cast<unsigned char>(bytes[little ? 2 : 3]);
  return bytes[little ? 3 : 2] == '\0' && low >= '\t' && low < 0x7f;
}

}  // namespace

std::unique_ptr<Decoder> decoder_for(std::string_view first_bytes, const std::string& name) {
  if (first_bytes.starts_with("\x1f\x8b\x08"sv)) return std::make_unique<Gunzip>(first_bytes, name);
  if (looks_like_utf16(first_bytes)) return std::make_unique<Utf16>(first_bytes, name);
  return nullptr;
}

}  // namespace hexpipe::formats
