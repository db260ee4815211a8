#pragma once
// The surface that a mesh was made of, as its user or the CAD gave it: finer than the mesh, and with its own sharp
// edges.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/mesh/box_tree.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::assemble::order {

class GivenSurface {
 public:
  explicit GivenSurface(formats::SurfaceSoup surface);

  // The nearest point of the triangles whose normals are less than 60 degrees from `normal` or its opposite, if it is
  // less than `most` away.
  std::optional<Vec3> on_faces(const Vec3& to, const Vec3& normal, double most) const;
  // The nearest point of the sharp edges and curves that are less than 45 degrees from `direction`, likewise.
  std::optional<Vec3> on_curves(const Vec3& to, const Vec3& direction, double most) const;

 private:
  using Segment = std::array<Vec3, 2>;

  std::array<Vec3, 3> corners(std::int32_t triangle) const;
  void find_curves(const formats::SurfaceSoup& surface);

  formats::SurfaceSoup surface_;
  std::vector<Segment> curves_;
  BoxTree triangle_tree_, curve_tree_;
};

}  // namespace hexpipe::assemble::order
