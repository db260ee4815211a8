#include "formats/streams/decoding.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "common/run/error.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe {
using namespace formats;
namespace {

using namespace std::string_literals;
using ::testing::HasSubstr;

std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  constexpr int largest_window = 15, as_gzip = 16, usual_memory = 8;
  EXPECT_EQ(
      deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, largest_window + as_gzip, usual_memory, Z_DEFAULT_STRATEGY),
      Z_OK);
  std::string packed(deflateBound(&stream, bytes.size()) + 64, '\0'), source = bytes;
  stream.next_in = reinterpret_cast<Bytef*>(source.data());
  stream.avail_in = static_cast<uInt>(source.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

std::string content_of(const std::string& bytes) {
  return Input::from_memory(bytes, "part").read_all();
}

std::string error_of(const std::string& bytes) {
  try {
    content_of(bytes);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

std::string much_text() {
  std::string text;
  for (int i = 0; i < 200000; ++i) text += std::to_string(i) + '\n';
  return text;
}

TEST(Decoding, UnpacksGzip) {
  for (const std::string& text : {""s, "v 0 0 0\n"s, "\0\1\2"s, much_text()})
    EXPECT_EQ(content_of(gzipped(text)), text);
  EXPECT_EQ(content_of(gzipped("one ") + gzipped("two")), "one two");
  EXPECT_EQ(content_of(gzipped("one") + std::string(1000, '\0')), "one");
  EXPECT_FALSE(Input::from_memory("plain", "part").is_decoded());
  Input packed = Input::from_memory(gzipped("packed"), "part");
  EXPECT_EQ(packed.peek(3), "pac");
  EXPECT_TRUE(packed.is_decoded());
  EXPECT_EQ(packed.read_all(), "packed");
}

TEST(Decoding, RefusesGzipThatIsCutOffOrDamaged) {
  const std::string packed = gzipped("a text that is packed");
  for (std::size_t length = 3; length < packed.size(); ++length)
    EXPECT_EQ(error_of(packed.substr(0, length)),
              "part: expected the rest of a gzip file, found its end; is it cut off?");
  std::string damaged = packed;
  damaged[packed.size() - 6] ^= 1;  // in the checksum
  EXPECT_EQ(error_of(damaged), "part: expected a whole gzip file, found a damaged one: incorrect data check");
  EXPECT_EQ(error_of(packed + "x"), "part: expected the end of a gzip file, found other bytes");
}

TEST(Decoding, RefusesGzipThatOnlyFillsTheMemory) {
  Input input = Input::from_memory(gzipped(std::string(1 << 29, '\0')), "part");
  std::size_t unpacked = 0;
  try {
    for (std::string_view bytes = input.read_some(); !bytes.empty(); bytes = input.read_some())
      unpacked += bytes.size();
    FAIL();
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("part: expected at most 250 bytes for each packed one, found more"));
  }
  EXPECT_LT(unpacked, std::size_t{1} << 29);
}

TEST(Decoding, MakesUtf8OfUtf16) {
  EXPECT_EQ(content_of("\xff\xfe"s), "");
  EXPECT_EQ(content_of("\xff\xfeg\0 \0\xe9\0\xac\x20\x3d\xd8\x27\xdd\n\0"s),
            "g \xc3\xa9\xe2\x82\xac\xf0\x9f\x94\xa7\n");
  EXPECT_EQ(content_of("\xfe\xff\0g\0 \0\xe9\x20\xac\xd8\x3d\xdd\x27\0\n"s),
            "g \xc3\xa9\xe2\x82\xac\xf0\x9f\x94\xa7\n");
  // Halves of pairs alone.
  EXPECT_EQ(content_of("\xff\xfeg\0\x27\xdd\x3d\xd8g\0\x3d\xd8"s), "g\xef\xbf\xbd\xef\xbf\xbdg\xef\xbf\xbd");
  EXPECT_EQ(error_of("\xff\xfeg\0g"s),
            "part: expected UTF-16 of two bytes a letter, found an odd number of bytes; is it cut off?");
  std::string large = "\xff\xfe", text = much_text();
  for (const char c : text) (large += c) += '\0';
  EXPECT_EQ(content_of(large), text);
  EXPECT_EQ(content_of(gzipped(large)), text);
}

TEST(Decoding, LeavesBinaryFilesThatBeginWithTheMark) {
  for (const std::string& bytes : {"\xff\xfe\0\0v\0\0\0"s, "\xff\xfe\x67\x68"s, "\xff"s, "\x1f\x8b"s})
    EXPECT_EQ(content_of(bytes), bytes);
}

}  // namespace
}  // namespace hexpipe
