#pragma once
// Parts in files of their own: part-0000.tar and so on in a directory.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/mesh-part/mesh_cutter.hpp"

namespace hexpipe {

class PartFiles {
 public:
  // Makes the directory unless it is there. Throws DataError when it holds parts beyond these, left by a run with more.
  PartFiles(std::string directory, std::int32_t parts, bool compress);
  // Without commit(), the files written are removed, and the directory where it was made here.
  ~PartFiles();
  PartFiles(const PartFiles&) = delete;
  PartFiles& operator=(const PartFiles&) = delete;

  // `history`: the entries that the part begins with.
  void write(const PartOfMesh& part, const std::vector<nlohmann::ordered_json>& history);
  void commit() {
    written_.clear();
    made_ = false;
  }

 private:
  std::string directory_;
  bool compress_, made_ = false;
  std::vector<std::string> written_;
};

}  // namespace hexpipe
