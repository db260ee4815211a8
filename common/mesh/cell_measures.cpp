#include "common/mesh/cell_measures.hpp"

namespace hexpipe {

HEXPIPE_ANY_REGISTERS void measure_cells(const std::array<LaneVector, 8>& corners, CellMeasures& measures) {
  measures = {least_corner_scaled_jacobian_of<HexTopology>(corners), cell_volume_of<HexTopology>(corners)};
}

HEXPIPE_ANY_REGISTERS void measure_cells(const std::array<LaneVector, 6>& corners, CellMeasures& measures) {
  measures = {least_corner_scaled_jacobian_of<PrismTopology>(corners), cell_volume_of<PrismTopology>(corners)};
}

HEXPIPE_ANY_REGISTERS void measure_cells(const std::array<LaneVector, 5>& corners, CellMeasures& measures) {
  measures = {least_corner_scaled_jacobian_of<PyramidTopology>(corners), cell_volume_of<PyramidTopology>(corners)};
}

}  // namespace hexpipe
