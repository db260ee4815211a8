#include "formats/streams/output_group.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

#include "common/run/error.hpp"
#include "common/run/open_files.hpp"

namespace hexpipe::formats {

OutputGroup::OutputGroup() {
  allow_many_open_files();
}

OutputGroup::~OutputGroup() {
  std::error_code ignored;
  written_.clear();
  for (const std::string& path : added_) std::filesystem::remove(path, ignored);
  if (!directory_.empty()) std::filesystem::remove(directory_, ignored);
}

void OutputGroup::make_directory(const std::string& path) {
  std::error_code error;
  const bool made = std::filesystem::create_directories(path, error);
  if (error) throw DataError::at(path, "cannot make the directory: {}", error.message());
  if (made) directory_ = path;
}

Output& OutputGroup::add(const std::string& path) {
  return *written_.emplace_back(std::make_unique<Output>(path));
}

void OutputGroup::commit() {
  added_.reserve(written_.size());
  for (auto at = written_.rbegin(); at != written_.rend(); ++at) {
    Output& output = **at;
    std::string path = output.name();
    std::error_code unknown;
    const bool is_there = std::filesystem::exists(path, unknown);
    output.commit();
    if (!is_there) added_.push_back(std::move(path));
  }
  added_.clear();
  directory_.clear();
}

}  // namespace hexpipe::formats
