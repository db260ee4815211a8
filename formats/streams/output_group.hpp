#pragma once
// Files that belong together. None gets its name before all are written, so that a failure leaves an older set of files
// as it was, and not half of each set.

#include <memory>
#include <string>
#include <vector>

#include "formats/streams/output.hpp"

namespace hexpipe::formats {

class OutputGroup {
 public:
  OutputGroup();
  // Unless commit() was called, removes all files, and the directory if it was made here.
  ~OutputGroup();
  OutputGroup(const OutputGroup&) = delete;
  OutputGroup& operator=(const OutputGroup&) = delete;

  // Makes a directory unless it is there; at most one. Throws DataError.
  void make_directory(const std::string& path);
  // Throws DataError as Output does. The caller should drain each output when it is written, as all stay open until the
  // end.
  Output& add(const std::string& path);
  // Puts the files in place, the last one first: a file that names the others has to be added first. Throws DataError
  // when one cannot be put in place; files that replaced another before that stay.
  void commit();

 private:
  std::string directory_;  // if it was made here
  std::vector<std::unique_ptr<Output>> written_;
  std::vector<std::string> added_;  // in place now, where there was no file before
};

}  // namespace hexpipe::formats
