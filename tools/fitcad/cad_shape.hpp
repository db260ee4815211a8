#pragma once
// The CAD's own faces and curves, and the point of them that is nearest to a given one.
//
// The triangles that tessellate made of each face lead to the place; Newton's method on the face itself finds the point
// to the last digit.

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
  // Throws DataError if OpenCASCADE cannot read the shape, or its tags do not fit to it.
  CadShape(const pipeline::ExactShape& shape, const std::string& source);
  ~CadShape();
  CadShape(CadShape&&) noexcept;

  // The nearest point of the faces, among those that lie up to `reach` further away than the nearest triangle. With
  // tags, faces that have one of them go before all others.
  Foot on_faces(const Vec3& to, double reach, std::span<const std::int32_t> tags = {}) const;
  // The nearest point of the curves that are features, if it is up to `reach` away.
  std::optional<Foot> on_curves(const Vec3& to, double reach) const;
  // The nearest end of such a curve, if it is up to `reach` away.
  std::optional<Vec3> on_corners(const Vec3& to, double reach) const;

  // Points that lie on the faces exactly and all over them.
  std::vector<Vec3> samples() const;

  std::size_t face_count() const;
  double diagonal() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hexpipe::fitcad
