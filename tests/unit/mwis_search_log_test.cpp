#include "common/mwis/ground/search_log.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "common/run/error.hpp"

namespace hexpipe {
using namespace mwis::ground;
namespace {

TEST(SearchLog, ThinsOutAndEndsWithTheLastPoint) {
  const std::string path = ::testing::TempDir() + "search_log_test.jsonl";
  SearchLog log(path);
  log.record(0.001, 1, 10);
  log.record(0.002, 2, 11);  // too soon after
  log.record(0.1, 3, 12);
  log.finish(0.1, 4, 13);
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  std::remove(path.c_str());
  EXPECT_EQ(lines, (std::vector<std::string>{R"({"seconds":0.001,"iteration":1,"weight":10})",
                                             R"({"seconds":0.100,"iteration":3,"weight":12})",
                                             R"({"seconds":0.100,"iteration":4,"weight":13})"}));
}

TEST(SearchLog, NamesItsValue) {
  const std::string path = ::testing::TempDir() + "search_log_bound_test.jsonl";
  SearchLog(path, "bound").finish(1, 2, 3);
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::remove(path.c_str());
  EXPECT_EQ(line, R"({"seconds":1.000,"iteration":2,"bound":3})");
}

TEST(SearchLog, NoticesWhatCannotBeWritten) {
  EXPECT_THROW(SearchLog("/no/such/directory/log"), DataError);
  SearchLog full("/dev/full");
  EXPECT_THROW(full.finish(1, 1, 1), DataError);
  EXPECT_NO_THROW(SearchLog("").finish(1, 1, 1));
}

}  // namespace
}  // namespace hexpipe
