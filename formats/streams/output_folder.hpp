#pragma once
// A folder of files, written beside its place and put there when it is whole: a failure leaves the old one as it was.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/run/removed_files.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

class OutputFolder {
 public:
  // If something is at `path` already, it must be a folder whose entries all are among `own` (with .gz or not): only a
  // folder of the same kind is replaced. Throws DataError.
  OutputFolder(const std::string& path, const std::vector<std::string_view>& own);
  // Without commit(), nothing is left of what was written.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::string& name() const { return name_; }
  // Throws DataError as Output does.
  Output& add(const std::string& file);
  // Throws DataError when any file, or the folder, cannot be put in place.
  void commit();

 private:
  [[noreturn]] void fail() const;

  std::string name_, path_;  // path_: behind links, without a slash at the end
  std::string temporary_;
  RemovedFile removed_;  // the temporary folder, while it is empty
  std::vector<std::unique_ptr<Output>> files_;
};

}  // namespace hexpipe::formats
