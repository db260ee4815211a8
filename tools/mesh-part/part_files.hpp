#pragma once
// Parts in files of their own: part-0000.tar and so on in a directory.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/streams/group_names.hpp"
#include "formats/streams/output_group.hpp"
#include "tools/mesh-part/mesh_cutter.hpp"

namespace hexpipe::mesh_part {

class PartFiles {
 public:
  // Makes the directory unless it is there. Throws DataError when it holds other parts than those that will be
  // replaced, left by a run with more, or compressed otherwise.
  PartFiles(std::string directory, std::int32_t parts, bool compress);

  // `history`: the entries that the part begins with; `names`: those of the whole mesh.
  void write(const PartOfMesh& part, const std::vector<nlohmann::ordered_json>& history,
             const formats::GroupNames& names);
  // Without it, nothing new is left. Throws DataError where a part cannot be put in place; those before it are.
  void commit() { files_.commit(); }

 private:
  std::string name_of(std::int32_t part) const;

  std::string directory_;
  bool compress_;
  formats::OutputGroup files_;
};

}  // namespace hexpipe::mesh_part
