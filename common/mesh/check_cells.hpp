#pragma once
// The checks that tet meshes and mixed meshes share. Messages name items as the arrays of a bundle do, counted from 0.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "common/mesh/vec3.hpp"
#include "common/run/error.hpp"

namespace hexpipe {

// Throws DataError naming `source` when a coordinate is too large or NaN, or when there are more points than 32 bits
// can number.
inline void check_points(std::span<const Vec3> points, const char* source) {
  if (points.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw DataError::at(source, "expected fewer than 2^31 points, found {}", points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!is_place(points[i]))
      throw DataError::at(source, "points[{}]: expected coordinates up to {}, found {} {} {}", i, largest_coordinate,
                          points[i].x, points[i].y, points[i].z);
}

// Throws DataError naming `source` when a cell names a missing vertex, or one vertex twice.
template <class Index, std::size_t Corners>
void check_corners(const std::vector<std::array<Index, Corners>>& cells, std::size_t point_count, const char* name,
                   const char* source) {
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t k = 0; k < Corners; ++k) {
      const Index v = cells[i][k];
      if (v < 0 || static_cast<std::size_t>(v) >= point_count)
        throw DataError::at(source, "{}[{}]: expected vertices from 0 to below {}, found {}", name, i, point_count, v);
      for (std::size_t j = 0; j < k; ++j)
        if (cells[i][j] == v)
          throw DataError::at(source, "{}[{}]: expected {} different vertices, found {} twice", name, i, Corners, v);
    }
}

// The same check; it also throws when there are not as many tags as cells.
template <class Index, std::size_t Corners>
void check_cells(const std::vector<std::array<Index, Corners>>& cells, const std::vector<std::int32_t>& tags,
                 std::size_t point_count, const char* name, const char* source) {
  if (tags.size() != cells.size())
    throw DataError::at(source, "expected a tag for each of {} {}, found {}", cells.size(), name, tags.size());
  check_corners(cells, point_count, name, source);
}

}  // namespace hexpipe
