#pragma once
// The fragments that a search improved, as viewmesh --fragments reads them: a line each, the numbers of its vertices
// from 1.

#include <cstdint>
#include <exception>
#include <span>
#include <string>

#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// A disk that is full in the middle of a search does not end it: commit() tells.
class FragmentsFile {
 public:
  // Throws DataError when the file cannot be opened.
  explicit FragmentsFile(const std::string& path) : output_(path) {}

  // `vertices` count from 0.
  void add(std::span<const std::uint64_t> vertices);
  // Throws DataError when this or anything before could not be written; then there is no file.
  void commit();

 private:
  Output output_;
  std::exception_ptr failure_;
};

}  // namespace hexpipe::formats
