#pragma once
// Writes the fragments that a search improved, as viewmesh --fragments reads them: each line has the numbers of a
// fragment's vertices, from 1.

#include <cstdint>
#include <exception>
#include <span>
#include <string>

#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// A disk that is full does not end a search: commit() reports it.
class FragmentsFile {
 public:
  // Throws DataError when the file cannot be opened.
  explicit FragmentsFile(const std::string& path) : output_(path) {}

  // `vertices` count from 0.
  void add(std::span<const std::uint64_t> vertices);
  // Throws DataError when anything could not be written; then there is no file.
  void commit();

 private:
  Output output_;
  std::exception_ptr failure_;
};

}  // namespace hexpipe::formats
