#include "tools/mesh-part/part_files.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/run/error.hpp"
#include "common/run/open_files.hpp"
#include "formats/bundle.hpp"
#include "formats/history.hpp"
#include "formats/members.hpp"

namespace hexpipe {
namespace {

constexpr std::string_view stem = "part-";

// Of "part-0012.tar": 12; of other names -1.
std::int32_t number_in(std::string_view name) {
  if (!name.starts_with(stem)) return -1;
  name.remove_prefix(stem.size());
  std::int32_t number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const std::string_view ending(end, static_cast<std::size_t>(name.data() + name.size() - end));
  return error == std::errc() && (ending == ".tar" || ending == ".tar.zst") ? number : -1;
}

}  // namespace

PartFiles::PartFiles(std::string directory, std::int32_t parts, bool compress)
    : directory_(std::move(directory)), compress_(compress) {
  std::error_code error;
  made_ = std::filesystem::create_directories(directory_, error);
  if (error) throw DataError::at(directory_, "cannot make the directory: {}", error.message());
  for (auto entry = std::filesystem::directory_iterator(directory_, error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (number_in(name) >= parts)
      throw DataError::at(directory_, "expected no parts but the {} to be written, found {}: remove it", parts, name);
  }
  if (error) throw DataError::at(directory_, "cannot list the directory: {}", error.message());
  allow_many_open_files();
}

PartFiles::~PartFiles() {
  std::error_code ignored;
  written_.clear();
  for (const std::string& path : added_) std::filesystem::remove(path, ignored);
  if (made_) std::filesystem::remove(directory_, ignored);
}

void PartFiles::write(const PartOfMesh& part, const std::vector<nlohmann::ordered_json>& history) {
  const std::string path = fmt::format("{}/{}{:04}.tar{}", directory_, stem, part.part.part, compress_ ? ".zst" : "");
  Output& output = *written_.emplace_back(std::make_unique<Output>(path));
  BundleWriter writer(output, compress_);
  write_members(writer, part.part);
  write_members(writer, part.mesh);
  write_history(writer, history);
  writer.close();
  output.drain();
}

void PartFiles::commit() {
  added_.reserve(written_.size());
  for (const auto& output : written_) {
    std::string path = output->name();
    std::error_code unknown;
    const bool is_there = std::filesystem::exists(path, unknown);
    output->commit();
    if (!is_there) added_.push_back(std::move(path));
  }
  added_.clear();
  made_ = false;
}

}  // namespace hexpipe
