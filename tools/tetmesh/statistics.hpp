#pragma once
// The figures that tetmesh reports: of the surface, the points, the mesh, and the time of each step.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tools/tetmesh/point_kind.hpp"
#include "tools/tetmesh/search/point_search.hpp"
#include "tools/tetmesh/solid/repair.hpp"

namespace hexpipe::tetmesh {

struct StepSeconds {
  // Steps follow each other. A step that runs while TetGen is at work counts in full, and TetGen only with the time for
  // which it is waited.
  double checking = 0, remeshing = 0, placing = 0, tetgen = 0, building = 0, comparing = 0, improving = 0;
  double of_tetgen = 0;  // processor time of all runs of TetGen

  StepSeconds& operator+=(const StepSeconds& other);
};

struct TriedSize {
  double size;
  std::optional<double> hex_share;  // nothing where TetGen failed
};

// In sizes; see volume/dislocations.hpp.
struct DislocationLengths {
  double all = 0, at_singularities = 0, closed = 0;
  std::size_t surface_ends = 0;
};

struct TetmeshStatistics {
  double size = 0;                   // the greatest
  std::optional<double> least_size;  // where sizes differ
  std::size_t surface_points = 0, surface_triangles = 0;
  bool remeshed = false;
  int surfaces_tried = 0;                                 // until one was as promised
  double distance_to_input = 0, distance_from_input = 0;  // Hausdorff distances between the new surface and the input
  std::size_t extra_points = 0;                           // vertices of the input that could not be removed
  std::size_t short_features = 0;                         // vertices of the input that went with features too short
  std::size_t shells = 0, regions = 0;
  std::size_t interior_points = 0;  // asked for
  std::optional<solid::RepairReport> repair;
  std::optional<std::size_t> united_bodies;
  PointKind points_kept = PointKind::none;
  // Shares of the volume in hexes, by a rough greedy choice; where several kinds of points were tried.
  std::optional<double> lattice_hex_share, frame_hex_share, mixed_hex_share;
  std::optional<std::int64_t> row_ends;            // on faces, of a surface made anew
  std::optional<DislocationLengths> dislocations;  // of points along a frame field
  std::size_t added_points = 0, dropped_points = 0;
  int tetgen_runs = 0;  // with those that failed
  std::size_t points = 0, tets = 0;
  double volume = 0;
  double least_dihedral = 0, greatest_dihedral = 0;  // degrees
  std::optional<double> hex_share;  // of this mesh, estimated in the same way; where several sizes were tried
  std::vector<TriedSize> tried;
  std::optional<search::PointSearchSummary> improved;
  StepSeconds seconds;  // of all tries
};

// All statistics that are the same in every run of the same command; the times, which differ, are in times_of().
nlohmann::ordered_json to_json(const TetmeshStatistics& statistics);
nlohmann::ordered_json times_of(const TetmeshStatistics& statistics);

}  // namespace hexpipe::tetmesh
