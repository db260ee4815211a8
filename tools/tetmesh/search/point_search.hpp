#pragma once
// A local search over the points: small changes where tets are left, of which those stay that bring hexes.
//
// A round tries changes at many places at the same time, as far from each other as what they change reaches: several
// meshes with another change at each place, then one with the best of each. So it costs a handful of runs of TetGen
// however large the part is, and a mesh of all changes decides, not the sum of what each would bring.

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
  // If there: called after each round, with the estimated share of the volume in hexes.
  std::function<void(std::size_t round, double share)> after_round = {};
};

// What a mesh is made of.
struct SurfaceWithPoints {
  solid::Surface surface;
  std::vector<Vec3> inside;
};

struct PointSearchSummary {
  std::size_t rounds = 0;              // that were finished
  std::size_t changes = 0;             // that stayed
  double share_before = 0, share = 0;  // of the volume in hexes, estimated
};

struct PointSearchResult {
  std::optional<solid::Surface> surface;  // where it changed
  tetgen::BuiltMesh built;
  PointSearchSummary summary;
};

// Makes a mesh of each, in any order, and hands it over with the number of what it is made of, one at a time. Where
// none can be made, that is passed over.
using TakeMesh = std::function<void(std::size_t number, tetgen::BuiltMesh)>;
using MakeMeshes = std::function<void(std::span<const SurfaceWithPoints>, const TakeMesh& take)>;

// From a mesh of the surface, whose points come first there. The same for the same seed and number of rounds, unless
// the deadline passes before.
PointSearchResult search_points(const solid::Surface& surface, tetgen::BuiltMesh start,
                                const PointSearchOptions& options, const Deadline& deadline,
                                const MakeMeshes& make_meshes);

}  // namespace hexpipe::tetmesh::search
