#pragma once
// What a result holds, for people (-v) and for programs (--stats).

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/conform.hpp"
#include "tools/assemble/self_check.hpp"
#include "tools/assemble/smooth.hpp"

namespace hexpipe {

inline constexpr std::array all_kinds{CellKind::hex, CellKind::prism, CellKind::pyramid, CellKind::tet};

struct KindStatistics {
  std::int64_t count = 0;
  double volume = 0;
  double least = 0, mean = 0;  // of the cells' least scaled Jacobian over corners; 0 when there are no cells
  std::array<std::int64_t, 10> histogram{};  // of the same, by tenths; below 0.1 (and below 0) first
};

struct AssembleStatistics {
  std::array<KindStatistics, all_kinds.size()> kinds;  // as in all_kinds
  std::int64_t points = 0, triangles = 0, quads = 0;
  CheckedVolumes volumes;
  ConformityCounts conformity;
  SmoothCounts smoothing;
  std::int64_t repaired = 0;                                      // vertices put beside flat tets
  std::array<KindStatistics, all_kinds.size()> before_smoothing;  // when there was smoothing

  std::int64_t cells() const;
};

// Fills in the quality of every cell, the least scaled Jacobian over its corners.
void compute_quality(MixedMesh& mesh);

// By kind; `mesh` has quality.
std::array<KindStatistics, all_kinds.size()> kind_statistics(const MixedMesh& mesh);

nlohmann::ordered_json to_json(const AssembleStatistics& statistics);
std::vector<std::string> summary_lines(const AssembleStatistics& statistics);

}  // namespace hexpipe
