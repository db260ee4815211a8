#pragma once
// Parts in files of their own: part-0000.tar and so on in a directory.

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/output.hpp"
#include "tools/mesh-part/mesh_cutter.hpp"

namespace hexpipe {

// None has its name before all are written: a failure leaves an older set of parts as it was, not half of each.
class PartFiles {
 public:
  // Makes the directory unless it is there. Throws DataError when it holds parts beyond these, left by a run with more.
  PartFiles(std::string directory, std::int32_t parts, bool compress);
  // Without commit(), nothing new is left, nor the directory where it was made here.
  ~PartFiles();
  PartFiles(const PartFiles&) = delete;
  PartFiles& operator=(const PartFiles&) = delete;

  // `history`: the entries that the part begins with.
  void write(const PartOfMesh& part, const std::vector<nlohmann::ordered_json>& history);
  // Throws DataError where a part cannot be put in place; those before it are.
  void commit();

 private:
  std::string directory_;
  bool compress_, made_ = false;
  std::vector<std::unique_ptr<Output>> written_;
  std::vector<std::string> added_;  // in place now, where there was none before
};

}  // namespace hexpipe
