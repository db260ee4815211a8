#pragma once
// A surface's triangles anew, on points that merge into quads and so into hexes: along its features, and between them
// in the directions of a cross field.

#include <memory>
#include <optional>
#include <string>

#include "common/mesh/feature_angle.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::surface {

struct RemeshOptions {
  sizing::SizeField size = 1;  // distance of the points
  double feature_angle = default_feature_angle;
  double deviation = 0.15;                     // of either surface from the other, at the most, in units
  std::optional<sizing::SizeField> unit = {};  // nothing: the size
  double row_stretch = 0;                      // in sizes: surface_lattice.hpp
};

struct RemeshResult {
  // Tags and places are those of the input's triangles, shells are the input's.
  solid::Surface surface;
  std::string failure;                  // where it failed: why, in a sentence; the surface is empty
  double from_input = 0, to_input = 0;  // greatest distances of points of the one from the other
  std::size_t feature_points = 0, front_points = 0;
  std::int64_t row_ends = 0;  // on faces, of the lattice of the points there
  // Of the input, that stay because the deviation, or a surface that does not intersect itself, asks for them.
  std::size_t extra_points = 0;
  int attempts = 0;
};

// Makes a surface, and another one where that is not what was promised, which is seldom. For callers that go on with it
// before it is known. Never throws for what the surface is like: where no new surface keeps what is promised, it says
// so.
class SurfaceRemesher {
 public:
  // The input stays where it is.
  SurfaceRemesher(const solid::Surface& surface, const RemeshOptions& options);
  ~SurfaceRemesher();

  // Makes the first surface, or the next one after one that was judged and is faulty. False where none is left to try.
  bool make();
  // Whether the one made last is as promised.
  bool judge();
  const solid::Surface& made() const;
  // The last one; good only where it was judged so.
  RemeshResult take();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

// More than memory holds: then no surface is made.
bool asks_for_too_many_points(const solid::Surface& surface, const sizing::SizeField& size);

RemeshResult remesh_surface(const solid::Surface& surface, const RemeshOptions& options);

}  // namespace hexpipe::tetmesh::surface
