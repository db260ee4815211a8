#pragma once
// A local search over the points: it makes small changes where tets are left, and keeps those that bring hexes.
//
// A round tries changes at many places at the same time, as far from each other as changes reach. It makes several
// meshes, each with another change at each place, and then one with the best change of each place. So it costs a
// handful of runs of TetGen, however large the model is, and a mesh of all changes decides, not the sum of what each
// change would bring.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/run/deadline.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/tetgen/build_mesh.hpp"

namespace hexpipe::tetmesh::search {

struct PointSearchOptions {
  sizing::SizeField size = 1;
  std::uint64_t seed = 1;
  std::size_t rounds = 0;
  bool changes_surface = false;  // within flat faces and along straight edges
  // If set, called after each round with the estimated share of the volume in hexes.
  std::function<void(std::size_t round, double share)> after_round = {};
};

// The surface and the points inside that a mesh is made of.
struct SurfaceWithPoints {
  solid::Surface surface;
  std::vector<Vec3> inside;
};

struct PointSearchSummary {
  std::size_t rounds = 0;              // finished ones
  std::size_t changes = 0;             // those that stayed
  double share_before = 0, share = 0;  // of the volume in hexes, estimated
};

struct PointSearchResult {
  std::optional<solid::Surface> surface;  // if it changed
  tetgen::BuiltMesh built;
  PointSearchSummary summary;
};

// Makes a mesh of each, in any order, and passes it on with the number of its input, one at a time. Inputs that make no
// mesh are skipped.
using TakeMesh = std::function<void(std::size_t number, tetgen::BuiltMesh)>;
using MakeMeshes = std::function<void(std::span<const SurfaceWithPoints>, const TakeMesh& take)>;

// `start` is a mesh of the surface, whose points come first. The result is the same for the same seed and number of
// rounds, unless the deadline passes first.
PointSearchResult search_points(const solid::Surface& surface, tetgen::BuiltMesh start,
                                const PointSearchOptions& options, const Deadline& deadline,
                                const MakeMeshes& make_meshes);

}  // namespace hexpipe::tetmesh::search
