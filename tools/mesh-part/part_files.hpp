#pragma once
// Writes parts to files: part-0000.tar and so on in a directory.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/pipeline/stage_data.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/streams/output_group.hpp"
#include "tools/mesh-part/mesh_cutter.hpp"

namespace hexpipe::mesh_part {

// What each part has of the whole mesh.
struct SharedMembers {
  const std::vector<nlohmann::ordered_json>& history;  // the entries that the part begins with
  const formats::GroupNames& names;
  const std::vector<pipeline::RawMember>& surface;
  const pipeline::DislocationSegments& dislocations;
};

class PartFiles {
 public:
  // Makes the directory unless it is there. Throws DataError when it holds parts that will not be replaced, left by a
  // run with more parts or with the other compression.
  PartFiles(std::string directory, std::int32_t parts, bool compress);

  void write(const PartOfMesh& part, const SharedMembers& shared);
  // Unless it is called, nothing new stays. Throws DataError when a part cannot be put in place; earlier ones stay.
  void commit() { files_.commit(); }

 private:
  std::string name_of(std::int32_t part) const;

  std::string directory_;
  bool compress_;
  formats::OutputGroup files_;
};

}  // namespace hexpipe::mesh_part
