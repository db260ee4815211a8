#include "formats/pipeline/bundle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "common/mesh/vec3.hpp"
#include "common/run/error.hpp"
#include "tests/unit/written_bytes.hpp"

namespace hexpipe {
using namespace formats;
using namespace pipeline;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// A bundle with whatever `fill` adds, as bytes.
template <class Fill>
std::string bundle_bytes(Fill&& fill, bool compress = false) {
  return hexpipe::testing::written_bytes([&](Output& output) {
    BundleWriter writer(output, compress);
    fill(writer);
    writer.close();
  });
}

const std::vector<std::array<std::int32_t, 4>> tets{{0, 1, 2, 3}, {4, 5, 6, 7}, {-1, 2, 3, 4}};
const std::vector<Vec3> points{{0, 0.1, 1e300}, {-1, 2, 3}};

std::string small_bundle(bool compress = false) {
  return bundle_bytes(
      [](BundleWriter& writer) {
        writer.add_array("mesh/points.npy", points);
        writer.add_array("mesh/tets.npy", tets);
        writer.add_text("history/01-test.json", "{}\n");
      },
      compress);
}

// Reads everything, as a tool would.
void read_through(const std::string& bytes) {
  Input input = Input::from_memory(bytes, "test");
  BundleReader reader(input);
  while (reader.next()) {
    if (reader.name() == "mesh/points.npy")
      reader.read_array<Vec3>();
    else if (reader.name() == "mesh/tets.npy")
      reader.read_array<std::array<std::int32_t, 4>>();
    else
      reader.read_text();
  }
}

TEST(Bundle, ComesBackAsItWasWritten) {
  for (const bool compress : {false, true}) {
    Input input = Input::from_memory(small_bundle(compress), "test");
    EXPECT_TRUE(looks_like_bundle(input));
    BundleReader reader(input);
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.read_array<Vec3>(), points);
    ASSERT_TRUE(reader.next());
    EXPECT_EQ((reader.read_array<std::array<std::int32_t, 4>>()), tets);
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.name(), "history/01-test.json");
    EXPECT_EQ(reader.read_text(), "{}\n");
    EXPECT_FALSE(reader.next());
  }
}

TEST(Bundle, EveryTruncatedPrefixIsAnError) {
  for (const bool compress : {false, true}) {
    const std::string bytes = small_bundle(compress);
    EXPECT_NO_THROW(read_through(bytes));
    // The archive ends with two blocks of zeros; the second is a formality that some writers leave out.
    const std::size_t complete = compress ? bytes.size() : bytes.size() - 512;
    for (std::size_t length = 0; length < complete; ++length)
      EXPECT_THROW(read_through(bytes.substr(0, length)), DataError) << length << " of " << bytes.size();
  }
}

TEST(Bundle, CutBetweenMembersThatEndInZerosIsAnError) {
  const std::string bytes = bundle_bytes(
      [](BundleWriter& writer) { writer.add_array("mesh/tet_tags.npy", std::vector<std::int32_t>(4096, 0)); });
  Input input = Input::from_memory(bytes.substr(0, 512 + 128 + 4 * 4096 + 384), "test");
  BundleReader reader(input);
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.read_array<std::int32_t>().size(), 4096u);
  EXPECT_THAT([&] { reader.next(); }, ThrowsMessage<DataError>(HasSubstr("cut off")));
}

TEST(Bundle, WrongShapesAndTypesAreErrorsThatNameTheMember) {
  const std::string bytes = small_bundle();
  auto read_first = [&]<class T>(std::vector<T>) {
    Input input = Input::from_memory(bytes, "test");
    BundleReader reader(input);
    reader.next();
    reader.read_array<T>();
  };
  EXPECT_THAT(
      [&] { read_first(std::vector<double>()); },
      ThrowsMessage<DataError>(HasSubstr("test: mesh/points.npy: expected an array of shape (n), found (2,3)")));
  EXPECT_THAT([&] { read_first(std::vector<std::array<double, 4>>()); }, ThrowsMessage<DataError>(HasSubstr("(n,4)")));
  EXPECT_THAT([&] { read_first(std::vector<std::array<std::int32_t, 3>>()); },
              ThrowsMessage<DataError>(HasSubstr("type i4, found f8")));
}

TEST(Bundle, TakesIntegersOfOtherWidthsWhereTheyFit) {
  const std::vector<std::int64_t> fits{1, -5, 2147483647}, too_large{1, 2147483648};
  const std::string bytes = bundle_bytes([&](BundleWriter& writer) {
    writer.add_array("a.npy", fits);
    writer.add_array("b.npy", too_large);
    writer.add_array("c.npy", std::vector<float>{0.5f});
  });
  Input input = Input::from_memory(bytes, "test");
  BundleReader reader(input);
  reader.next();
  EXPECT_THAT(reader.read_array<std::int32_t>(), ElementsAre(1, -5, 2147483647));
  reader.next();
  EXPECT_THAT([&] { reader.read_array<std::int32_t>(); }, ThrowsMessage<DataError>(HasSubstr("fit 4 bytes")));
  reader.next();
  EXPECT_THAT(reader.read_array<double>(), ElementsAre(0.5));
}

TEST(Bundle, RefusesFloatsOfHalfWidthByName) {
  const std::string bytes = bundle_bytes([](BundleWriter& writer) {
    writer.add_text("a.npy", npy_header({{'f', 2}, {3}}) + std::string(6, '\0'));
  });
  Input input = Input::from_memory(bytes, "test");
  BundleReader reader(input);
  reader.next();
  EXPECT_THAT([&] { reader.read_array<double>(); },
              ThrowsMessage<DataError>(HasSubstr("test: a.npy: expected numbers of type f8, found f2")));
}

TEST(Bundle, AnArrayThatOnlyClaimsToBeHugeIsRefusedWithoutAllocatingIt) {
  const std::string header = npy_header({{'i', 4}, {std::uint64_t{1} << 62}});
  const std::string bytes = bundle_bytes([&](BundleWriter& writer) { writer.add_text("a.npy", header + "1234"); });
  Input input = Input::from_memory(bytes, "test");
  BundleReader reader(input);
  reader.next();
  EXPECT_THROW(reader.read_array<std::int32_t>(), DataError);
}

TEST(Bundle, CopiesMembersUntouched) {
  const std::string bytes = small_bundle();
  const std::string copy = bundle_bytes([&](BundleWriter& writer) {
    Input input = Input::from_memory(bytes, "test");
    BundleReader reader(input);
    while (reader.next()) reader.copy_to(writer);
  });
  EXPECT_EQ(copy, bytes);
}

TEST(Bundle, RefusesNamesThatLeadOut) {
  for (const char* name : {"../x.npy", "/etc/x", "mesh/../../x"}) {
    const std::string bytes = bundle_bytes([&](BundleWriter& writer) { writer.add_text(name, "x"); });
    Input input = Input::from_memory(bytes, "test");
    BundleReader reader(input);
    EXPECT_THROW(reader.next(), DataError) << name;
  }
}

TEST(Npy, HeaderIsAlignedAndReadsBack) {
  const std::string header = npy_header({{'f', 8}, {12345, 3}});
  EXPECT_EQ(header.size() % 64, 0u);
  EXPECT_EQ(npy_header_size(header), header.size());
  const NpyHeader parsed = parse_npy_header(header, "test");
  EXPECT_EQ(parsed.type, (NpyType{'f', 8}));
  EXPECT_THAT(parsed.shape, ElementsAre(12345, 3));
}

TEST(Npy, RefusesOtherByteOrdersAndFortranOrder) {
  auto header_with = [](std::string from, const std::string& to) {
    std::string header = npy_header({{'f', 8}, {2, 3}});
    header.replace(header.find(from), from.size(), to);
    return header;
  };
  EXPECT_THROW(parse_npy_header(header_with("<f8", ">f8"), "test"), DataError);
  EXPECT_THROW(parse_npy_header(header_with("<f8", "<c8"), "test"), DataError);
  EXPECT_THROW(parse_npy_header(header_with("False", "True "), "test"), DataError);
  EXPECT_THROW(parse_npy_header(header_with("shape", "shame"), "test"), DataError);
}

TEST(Output, LeavesTheOldFileWhenItIsNotCommitted) {
  const std::string path = hexpipe::testing::temporary_path("output_test.txt");
  {
    Output output(path);
    output.write("old");
    output.commit();
  }
  {
    Output output(path);
    output.write("new");
  }
  EXPECT_EQ(hexpipe::testing::read_file(path), "old");
  std::remove(path.c_str());
}

TEST(Output, AFullDiskIsAnError) {
  Output output("/dev/full");
  output.write("some text");
  EXPECT_THAT([&] { output.commit(); }, ThrowsMessage<DataError>(HasSubstr("/dev/full: cannot write: No space left")));
}

TEST(Input, PeeksWithoutTakingAcrossItsBuffer) {
  const std::string path = hexpipe::testing::temporary_path("input_test.bin");
  std::string bytes(3 << 20, 'x');
  bytes[5] = 'y';
  std::ofstream(path, std::ios::binary) << bytes;
  Input input = Input::open(path);
  EXPECT_EQ(input.peek(10), "xxxxxyxxxx");
  EXPECT_EQ(input.peek(2 << 20).size(), std::size_t{2 << 20});
  EXPECT_EQ(input.read_all(), bytes);
  std::remove(path.c_str());
}

TEST(BundleWriter, TakesMoreThanTwoGigabytesAtOnce) {
  // Never touched, so that no memory is behind them.
  const std::size_t bytes = (std::size_t{2} << 30) + 100;
  void* const zeros = mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  ASSERT_NE(zeros, MAP_FAILED);
  Output output("/dev/null");
  BundleWriter writer(output, false);
  writer.begin_member("zeros", bytes);
  EXPECT_NO_THROW(writer.write(zeros, bytes));
  EXPECT_NO_THROW(writer.close());
  munmap(zeros, bytes);
}

}  // namespace
}  // namespace hexpipe
