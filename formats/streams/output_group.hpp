#pragma once
// Files that belong together: none has its name before all are written, so that a failure leaves an older set of them
// as it was, not half of each.

#include <memory>
#include <string>
#include <vector>

#include "formats/streams/output.hpp"

namespace hexpipe::formats {

class OutputGroup {
 public:
  OutputGroup();
  // Without commit(), nothing new is left, nor a directory that was made here.
  ~OutputGroup();
  OutputGroup(const OutputGroup&) = delete;
  OutputGroup& operator=(const OutputGroup&) = delete;

  // Unless it is there. Throws DataError. One at most.
  void make_directory(const std::string& path);
  // Throws DataError as Output does. What is written should be drained, for all stay open until the end.
  Output& add(const std::string& path);
  // The last first: what names the others is to be added first. Throws DataError where one cannot be put in place; of
  // those before it, the ones that replaced another are there.
  void commit();

 private:
  std::string directory_;  // that was made here
  std::vector<std::unique_ptr<Output>> written_;
  std::vector<std::string> added_;  // in place now, where there was none before
};

}  // namespace hexpipe::formats
