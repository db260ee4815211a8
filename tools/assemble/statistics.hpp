#pragma once
// What a result holds, for people (-v) and for programs (--stats).

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/choice/exchange.hpp"
#include "tools/assemble/conform/conform.hpp"
#include "tools/assemble/self_check.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe::assemble {

inline constexpr std::array all_kinds{CellKind::hex, CellKind::prism, CellKind::pyramid, CellKind::tet};

struct KindStatistics {
  std::int64_t count = 0;
  double volume = 0;
  double least_inside = 0;     // of the scaled Jacobian anywhere in the cells
  double least = 0, mean = 0;  // of the cells' least scaled Jacobian over corners; 0 when there are no cells
  std::array<std::int64_t, 10> histogram{};  // of the same, by tenths; below 0.1 (and below 0) first
};

// A cell that is worse than meshes should have: a hex below 0.1, another below 0.02 (a tet times the square root of 2).
struct PoorCell {
  CellKind kind;
  std::int64_t index;  // among its kind, from 0
  double quality;
  Vec3 middle;
};

struct AssembleStatistics {
  std::array<KindStatistics, all_kinds.size()> kinds;  // as in all_kinds
  std::int64_t points = 0, triangles = 0, quads = 0;
  CheckedVolumes volumes;
  std::optional<choice::ExchangeCounts> exchange;  // where hexes may be exchanged
  conform::ConformityCounts conformity;
  std::int64_t filling_prisms = 0;  // made of the tets between the chosen cells; some may have gone back since
  shape::SmoothCounts smoothing;
  std::vector<PoorCell> poor;                                     // all that are left
  std::int64_t exchanges = 0;                                     // of poor tets for others on the same vertices
  std::int64_t repaired = 0;                                      // vertices put beside flat tets
  std::int64_t peeled = 0;                                        // flat tets taken off the boundary
  std::array<KindStatistics, all_kinds.size()> before_smoothing;  // when there was smoothing

  std::int64_t cells() const;
};

// Fills in the quality of every cell, the least scaled Jacobian over its corners.
void compute_quality(MixedMesh& mesh);

// By kind; `mesh` has quality.
std::array<KindStatistics, all_kinds.size()> kind_statistics(const MixedMesh& mesh);

// The least scaled Jacobian anywhere in a cell, by kind (quality.hpp: to 1e-4).
std::array<double, all_kinds.size()> least_inside(const MixedMesh& mesh);

// By kind and index; `mesh` has quality.
std::vector<PoorCell> poor_cells(const MixedMesh& mesh);

nlohmann::ordered_json to_json(const AssembleStatistics& statistics);
std::vector<std::string> summary_lines(const AssembleStatistics& statistics);

}  // namespace hexpipe::assemble
