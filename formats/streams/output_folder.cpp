#include "formats/streams/output_folder.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "common/run/error.hpp"
#include "common/run/open_files.hpp"

namespace hexpipe::formats {
namespace {

std::string without_last_slash(std::string path) {
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  return path;
}

void check_replaceable(const std::string& path, const std::string& name, const std::vector<std::string_view>& own) {
  if (!std::filesystem::is_directory(path))
    throw DataError::at(name, "expected a folder to write, or nothing there, found something else");
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    std::string file = entry.path().filename();
    if (file.ends_with(".gz")) file.resize(file.size() - 3);
    if (std::ranges::find(own, file) == own.end())
      throw DataError::at(name, "the folder holds '{}', which is none of the files to be replaced: it is left alone",
                          entry.path().filename().string());
  }
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, const std::vector<std::string_view>& own) : name_(path) {
  path_ = behind_links(without_last_slash(path));
  struct stat status {};
  mode_t mode = 0;
  if (stat(path_.c_str(), &status) == 0) {
    try {
      check_replaceable(path_, name_, own);
    } catch (const std::filesystem::filesystem_error& error) {
      throw DataError::at(name_, "cannot write: {}", error.code().message());
    }
    mode = status.st_mode & 07777;
  } else {
    const mode_t mask = umask(0);
    umask(mask);
    mode = 0777 & ~mask;
  }
  temporary_ = path_ + ".XXXXXX";
  if (mkdtemp(temporary_.data()) == nullptr) {
    temporary_.clear();
    fail();
  }
  removed_.set(temporary_.c_str());
  if (chmod(temporary_.c_str(), mode | S_IRWXU) != 0) fail();
}

OutputFolder::~OutputFolder() {
  files_.clear();
  if (temporary_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove_all(temporary_, ignored);
  removed_.set("");
}

void OutputFolder::fail() const {
  throw DataError::at(name_, "cannot write: {}", std::strerror(errno));
}

Output& OutputFolder::add(const std::string& file) {
  return *files_.emplace_back(std::make_unique<Output>(temporary_ + "/" + file));
}

void OutputFolder::commit() {
  for (const auto& file : files_) file->commit();
  files_.clear();
  const bool is_there = access(path_.c_str(), F_OK) == 0;
  // The old one goes to the temporary name in the same step, and is removed from there.
  if (is_there ? renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) != 0
               : rename(temporary_.c_str(), path_.c_str()) != 0)
    fail();
  std::error_code ignored;
  if (is_there) std::filesystem::remove_all(temporary_, ignored);
  temporary_.clear();
  removed_.set("");
}

}  // namespace hexpipe::formats
