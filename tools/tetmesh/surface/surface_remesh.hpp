#pragma once
// Makes a surface's triangles anew, on points that merge into quads and so into hexes: along its features, and between
// them in the directions of a cross field.

#include <memory>
#include <optional>
#include <string>

#include "common/mesh/defaults.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/surface/surface_lattice.hpp"

namespace hexpipe::tetmesh::surface {

struct RemeshOptions {
  sizing::SizeField size = 1;  // distance of the points
  double feature_angle = default_feature_angle;
  double deviation = 0.15;                     // the greatest distance of either surface from the other, in units
  std::optional<sizing::SizeField> unit = {};  // nothing: the size
  RowOptions rows = {};
};

struct RemeshResult {
  // Tags and places come from the input's triangles; the shells are the input's.
  solid::Surface surface;
  std::string failure;                  // if it failed: the reason, in a sentence; the surface is empty
  double from_input = 0, to_input = 0;  // greatest distance of a point of one surface from the other
  std::size_t feature_points = 0, front_points = 0;
  std::int64_t row_ends = 0;  // on faces, of the lattice of the points there
  // Vertices of the input that stay because of the deviation, or because the surface would intersect itself without
  // them.
  std::size_t extra_points = 0;
  std::vector<bool> on_feature;  // by point of the surface
  int attempts = 0;
};

// Makes a surface, and another one in the rare case that the first is not as promised. The caller can work with a
// surface before it is judged. It never throws because of the surface: if no new surface is as promised, it says so.
class SurfaceRemesher {
 public:
  // `shape` is the given surface, or that without its short features. Both must outlive the remesher. The new surface
  // keeps its distance from the shape; the result has that from the given one.
  SurfaceRemesher(const solid::Surface& given, const solid::Surface& shape, const RemeshOptions& options);
  SurfaceRemesher(const solid::Surface& surface, const RemeshOptions& options)
      : SurfaceRemesher(surface, surface, options) {}
  ~SurfaceRemesher();

  // Makes the first surface, or the next one after a faulty one. Returns false if there is nothing left to try.
  bool make();
  // Begins anew with points where a lattice that is known by now has them. To be called after a first surface was made;
  // the next make() makes the first surface of these points.
  void follow(const RowGuide& guide);
  // Whether the last surface is as promised.
  bool judge();
  const solid::Surface& made() const;
  // The last surface. It is good only if judge() said so.
  RemeshResult take();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

// Whether the sizes ask for more points than memory holds. Then no surface is made.
bool asks_for_too_many_points(const solid::Surface& surface, const sizing::SizeField& size);

// For surfaces whose triangles cannot be made anew: cuts triangles until none is much larger than the size.
// Cuts the longest edge in its middle, with all of its triangles, until no edge is longer than one and a half sizes.
// The surface and its points stay where they are. Triangles of a sheet stay together.
solid::Surface split_long_edges(const solid::Surface& surface, const sizing::SizeField& size);

}  // namespace hexpipe::tetmesh::surface
