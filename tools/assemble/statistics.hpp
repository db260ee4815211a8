#pragma once
// The numbers of a result, for people (-v) and for programs (--stats).

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/mesh/mesh_measures.hpp"
#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/choice/exchange.hpp"
#include "tools/assemble/conform/conform.hpp"
#include "tools/assemble/gap/fewer_cells.hpp"
#include "tools/assemble/layers/layers.hpp"
#include "tools/assemble/self_check.hpp"

namespace hexpipe::assemble {

inline constexpr std::array all_kinds{CellKind::hex, CellKind::prism, CellKind::pyramid, CellKind::tet};

struct KindStatistics {
  std::int64_t count = 0;
  double volume = 0;
  double least_inside = 0;     // the least scaled Jacobian anywhere in the cells
  double least = 0, mean = 0;  // of the cells' least scaled Jacobian over corners; 0 if there are no cells
  std::array<std::int64_t, 10> histogram{};  // of the same, in tenths; all below 0.1 come first
};
using KindTable = std::array<KindStatistics, all_kinds.size()>;  // as in all_kinds

// How often smoothing moved vertices, mended flat tets (conform/flat_tets.hpp), and made cells between the hexes fewer.
struct ImprovementCounts {
  int rounds = 0;
  std::int64_t moves = 0;
  std::int64_t flips = 0;
  std::int64_t vertices = 0;  // inserted beside flat tets
  std::int64_t peeled = 0;    // flat tets peeled off the boundary
  gap::FewerCells fewer;
};

// A hex below poor_hex, or another cell below poor_quality (smooth.hpp).
struct PoorCell {
  CellKind kind;
  std::int64_t index;  // among its kind, from 0
  double quality;
  Vec3 middle;
};

struct AssembleStatistics {
  KindTable kinds;
  std::int64_t points = 0, triangles = 0, quads = 0;
  CheckedVolumes volumes;
  std::optional<choice::ExchangeCounts> exchange;  // if hexes may be exchanged
  conform::ConformityCounts conformity;
  std::int64_t filling_prisms = 0;  // some may have gone back to their tets since
  ImprovementCounts improvement;
  KindTable before_smoothing;                         // if there was smoothing
  std::vector<PoorCell> poor;                         // all that are left
  std::optional<layers::LayerCounts> layers, pillow;  // if they were asked for
  std::optional<MeshMeasures> measures;  // of whole meshes: on the seam of a piece cells have no neighbours

  std::int64_t cells() const;
};

// Computes the quality of every cell: the least scaled Jacobian over its corners.
void compute_quality(MixedMesh& mesh);

// By kind; `mesh` has quality.
KindTable kind_statistics(const MixedMesh& mesh);

// By kind and index; `mesh` has quality.
std::vector<PoorCell> poor_cells(const MixedMesh& mesh);

// Computes quality, and counts and judges the cells and facets of a result.
void count_cells(MixedMesh& mesh, AssembleStatistics& statistics);

nlohmann::ordered_json to_json(const AssembleStatistics& statistics);
std::vector<std::string> summary_lines(const AssembleStatistics& statistics);
// Where walls have less than was asked for, if they have.
std::optional<std::string> layers_warning(const AssembleStatistics& statistics);
// Where the boundary has no pillow, if it was asked for.
std::optional<std::string> pillow_warning(const AssembleStatistics& statistics);

}  // namespace hexpipe::assemble
