#pragma once
// The CAD's own faces and curves, and the points of them that are nearest to a given one.
//
// The triangles that tessellate made of each face give a start; Newton's method on the face itself finds the point to
// the last digits. All points and lengths are in the unit of the mesh.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/vec3.hpp"
#include "formats/pipeline/exact_shape.hpp"

namespace hexpipe::fitcad {

// A point on the CAD.
struct Foot {
  Vec3 at;
  double distance = 0;  // from the point that was asked for
};

class CadShape {
 public:
  // `source` is what messages call the file. Throws DataError if OpenCASCADE cannot read the shape, or if the lists of
  // tags do not match its faces and curves.
  CadShape(const pipeline::ExactShape& shape, const std::string& source);
  ~CadShape();
  CadShape(CadShape&&) noexcept;

  // The nearest point of the faces. Only faces count whose triangles are at most `reach` further away than the nearest
  // one. If some of these have one of the tags, the others do not count.
  Foot on_faces(const Vec3& to, double reach, std::span<const std::int32_t> tags = {}) const;
  // The nearest point of the curves that are features (as tessellate marks them); nullopt if it is more than `reach`
  // away. If some curves within reach have faces of just these tags around them, the others do not count.
  std::optional<Foot> on_curves(const Vec3& to, double reach, std::span<const std::int32_t> tags) const;
  // The same for curves that have this tag on all sides; for all curves if no face has the tag.
  std::optional<Foot> on_curves_within(const Vec3& to, double reach, std::int32_t tag) const;
  // The nearest end of such a curve; nullopt if it is more than `reach` away.
  std::optional<Vec3> on_corners(const Vec3& to, double reach) const;

  // Points on the faces, exactly and all over them: the vertices of all triangles, and a point for each triangle.
  std::vector<Vec3> samples() const;

  std::size_t face_count() const;
  double diagonal() const;  // of the bounding box

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hexpipe::fitcad
