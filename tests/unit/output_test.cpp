#include "formats/streams/output.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <string>
#include <thread>

#include "common/run/deadline.hpp"
#include "written_bytes.hpp"

namespace hexpipe {
using namespace formats;
namespace {

// Writes to a reader that takes 64 KiB every so often, after the search was told to stop by SIGTERM.
void write_to_slow_reader(const std::string& path, useconds_t microseconds) {
  install_signal_handlers();
  stop_searches_on_signal();
  if (mkfifo(path.c_str(), 0600) != 0) _exit(1);
  std::thread reader([&] {
    const int descriptor = open(path.c_str(), O_RDONLY);
    std::array<char, 1 << 16> bytes;
    while (read(descriptor, bytes.data(), bytes.size()) > 0) usleep(microseconds);
    close(descriptor);
  });
  {
    Output output(path);
    raise(SIGTERM);
    output.write(std::string(std::size_t{21} << 16, 'x'));
    output.commit();
  }
  reader.join();
  _exit(unlink(path.c_str()));
}

// A search that was told to stop by SIGTERM opens a FIFO that nobody reads.
void open_without_reader(const std::string& path) {
  install_signal_handlers();
  stop_searches_on_signal();
  raise(SIGTERM);
  if (mkfifo(path.c_str(), 0600) != 0) _exit(1);
  const Output output(path);
  _exit(2);
}

TEST(OutputDeathTest, ASearchThatWasStoppedDoesNotWaitForAReaderThatNeverComes) {
  const std::string path = hexpipe::testing::temporary_path("unread");
  EXPECT_EXIT(open_without_reader(path), ::testing::KilledBySignal(SIGTERM), "");
  unlink(path.c_str());
}

// Twenty pieces take longer than a reader that is stuck is waited for.
TEST(OutputDeathTest, ASearchThatWasStoppedWritesAllOfItsAnswerToAReaderThatIsSlow) {
  const std::string path = hexpipe::testing::temporary_path("slow");
  EXPECT_EXIT(write_to_slow_reader(path, 200'000), ::testing::ExitedWithCode(0), "");
  unlink(path.c_str());
}

}  // namespace
}  // namespace hexpipe
