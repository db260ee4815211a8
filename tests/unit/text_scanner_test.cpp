#include "formats/streams/text_scanner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace hexpipe {
using namespace formats;
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(TextScanner, TakesWordsAndNumbersWithTheirLines) {
  TextScanner scanner("one 2\n\n 3.5e1 # four\n+5", "f", '#');
  EXPECT_EQ(scanner.word("a word"), "one");
  EXPECT_EQ(scanner.number<int>("a number"), 2);
  EXPECT_EQ(scanner.line(), 1);
  EXPECT_EQ(scanner.peek_word(), "3.5e1");
  EXPECT_EQ(scanner.number<double>("a number"), 35);
  EXPECT_EQ(scanner.line(), 3);
  EXPECT_FALSE(scanner.at_end());
  EXPECT_EQ(scanner.number<int>("a number"), 5);
  EXPECT_EQ(scanner.line(), 4);
  EXPECT_TRUE(scanner.at_end());
  EXPECT_EQ(scanner.peek_word(), "");
}

TEST(TextScanner, CountsLinesFromTheGivenOne) {
  TextScanner scanner("a\nb", "f", '\0', 10);
  scanner.word("a word");
  scanner.word("a word");
  EXPECT_EQ(scanner.line(), 11);
}

TEST(TextScanner, ACommentEndsAWord) {
  TextScanner scanner("1#2\n3 #", "f", '#');
  EXPECT_EQ(scanner.number<int>("a number"), 1);
  EXPECT_TRUE(scanner.at_line_end());
  EXPECT_EQ(scanner.number<int>("a number"), 3);
  EXPECT_TRUE(scanner.at_end());
}

TEST(TextScanner, WithoutACommentCharacterNothingIsSkipped) {
  TextScanner scanner(std::string_view("#\0 x", 4), "f");
  EXPECT_EQ(scanner.word("a word"), std::string_view("#\0", 2));
  EXPECT_EQ(scanner.word("a word"), "x");
}

template <class T>
std::string message_of(std::string_view text) {
  TextScanner scanner(text, "f");
  try {
    scanner.number<T>("a number");
  } catch (const FormatError& error) {
    return error.what();
  }
  return "";
}

TEST(TextScanner, RefusesWhatIsNoNumberOfTheType) {
  EXPECT_EQ(message_of<int>("x"), "f:1: expected a number, found 'x'");
  EXPECT_EQ(message_of<int>("\n1.5"), "f:2: expected a number, found '1.5'");
  EXPECT_EQ(message_of<int>("3000000000"), "f:1: expected a number, found '3000000000'");
  EXPECT_EQ(message_of<unsigned>("-1"), "f:1: expected a number, found '-1'");
  EXPECT_EQ(message_of<int>("+-1"), "f:1: expected a number, found '+-1'");
  EXPECT_EQ(message_of<int>("\n\n"), "f:3: expected a number, found end of file");
  for (const char* word : {"nan", "-inf", "1e400", "-1e400", "1.0x", "1e5e", "+", "-", "1e400x", "0x10"})
    EXPECT_EQ(message_of<double>(word), std::string("f:1: expected a number, found '") + word + "'");
}

TEST(TextScanner, TakesNumbersAtTheLimits) {
  TextScanner scanner("1e-400 -1e-400 5e-324 1.7976931348623157e308 -9223372036854775808", "f");
  EXPECT_EQ(scanner.number<double>("a number"), 0);
  EXPECT_EQ(scanner.number<double>("a number"), 0);
  EXPECT_EQ(scanner.number<double>("a number"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(scanner.number<double>("a number"), std::numeric_limits<double>::max());
  EXPECT_EQ(scanner.number<std::int64_t>("a number"), std::numeric_limits<std::int64_t>::min());
  EXPECT_TRUE(scanner.at_end());
}

TEST(TextScanner, ExpectIgnoresCase) {
  TextScanner scanner("VerTices End", "f");
  scanner.expect("vertices");
  EXPECT_THAT([&] { scanner.expect("Vertices"); },
              ThrowsMessage<FormatError>(HasSubstr("f:1: expected Vertices, found 'End'")));
}

TEST(TextScanner, TakesTheRestOfALine) {
  TextScanner scanner("a b c # d\r\n\r\ne", "f", '#');
  scanner.word("a word");
  EXPECT_EQ(scanner.rest_of_line(), " b c ");
  EXPECT_EQ(scanner.line(), 2);
  EXPECT_EQ(scanner.rest_of_line(), "");
  EXPECT_EQ(scanner.rest_of_line(), "e");
  EXPECT_EQ(scanner.rest_of_line(), "");
  EXPECT_EQ(scanner.line(), 3);
}

TEST(TextScanner, TakesRawBytes) {
  TextScanner scanner("x\n\1\n\2y", "f");
  scanner.rest_of_line();
  EXPECT_EQ(scanner.raw(3, "data"), "\1\n\2");
  EXPECT_EQ(scanner.line(), 3);
  EXPECT_EQ(scanner.bytes_left(), 1u);
  EXPECT_THAT([&] { scanner.raw(2, "data"); },
              ThrowsMessage<FormatError>(HasSubstr("expected 2 bytes of data, found 1")));
}

TEST(TextScanner, SkipsPastAWord) {
  TextScanner scanner("a\n\n$End b", "f");
  scanner.skip_past("$End");
  EXPECT_EQ(scanner.line(), 3);
  EXPECT_EQ(scanner.word("a word"), "b");
  EXPECT_THAT([&] { scanner.skip_past("$End"); },
              ThrowsMessage<FormatError>(HasSubstr("f:3: expected $End, found end of file")));
}

TEST(TextScanner, ChecksCountsAgainstWhatIsLeft) {
  TextScanner enough("3 1 2 3", "f");
  EXPECT_EQ(enough.count("the number of items", 2), 3u);
  TextScanner short_text("4 1 2 3", "f");
  EXPECT_THAT([&] { short_text.count("the number of items", 2); },
              ThrowsMessage<FormatError>(
                  HasSubstr("f:1: expected the number of items that the rest of the file can hold, found 4")));
  TextScanner huge("18446744073709551615 1", "f");
  EXPECT_THROW(huge.count("the number of items", 1), FormatError);
  TextScanner none("0", "f");
  EXPECT_EQ(none.count("the number of items", 8), 0u);
}

TEST(TextScanner, ShowsWordsInMessagesWithoutControlCharacters) {
  EXPECT_EQ(quote_found(""), "end of file");
  EXPECT_EQ(quote_found("a\x1b[0m\xff"), "'a?[0m?'");
  EXPECT_EQ(quote_found(std::string(50, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(TextScanner, ComparesAsciiWithoutCase) {
  EXPECT_TRUE(equal_ignoring_case("aBc", "AbC"));
  EXPECT_FALSE(equal_ignoring_case("abc", "abcd"));
  EXPECT_FALSE(equal_ignoring_case("[", "{"));
}

}  // namespace
}  // namespace hexpipe
