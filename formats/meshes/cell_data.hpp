#pragma once
// The data that files have for each cell and each facet, in the order of the blocks. A facet has the data of its cell,
// so that programs that draw both on top of each other draw the same.

#include <cstdint>
#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::formats {

inline constexpr std::string_view quality_name = "quality";

struct CellData {
  std::vector<std::int32_t> region;
  std::vector<std::int32_t> surface;  // 0 for cells
  std::vector<std::uint8_t> kind;     // VTK's code of the cell, for its facets too
  std::vector<double> quality;        // empty unless every cell has one
};

CellData cell_data(const MixedMesh& mesh);

}  // namespace hexpipe::formats
