#pragma once
// A length at every place: how long edges should be there, or what is measured in such lengths.
//
// Sizes are known at some places and may grow with the distance from them. The field is the greatest function that is
// at most the known size at each of these places, at most a greatest size elsewhere, and differs between any two places
// by at most `grading` times their distance. That is min over y of h(y) + grading |x - y| (P.-O. Persson: Mesh size
// functions for implicit geometries and PDE-based gradient limiting, 2006, section 3). Here it is computed exactly for
// sizes that are linear on points, segments, triangles and tets, or constant in right prisms.

#include <array>
#include <memory>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::sizing {

// Leads from a triangle straight across; the size is the same in all of it.
struct SizePrism {
  std::array<Vec3, 3> corners;
  Vec3 across;  // at right angles to the triangle
  double size;
};

// The places where sizes are known.
struct SizeSources {
  std::vector<Vec3> points;
  std::vector<double> sizes;  // at the points
  // Each has one to four points; the rest is no_index. Sizes are linear in between.
  std::vector<std::array<Vertex, 4>> simplices;
  std::vector<SizePrism> prisms;

  bool empty() const { return simplices.empty() && prisms.empty(); }
};

class SizeField {
 public:
  // The same size everywhere. The constructor is implicit, so that a length can stand where a field is expected.
  SizeField(double uniform) : greatest_(uniform), least_(uniform) {}
  SizeField(SizeSources sources, double greatest, double grading);

  double at(const Vec3& p) const { return known_ ? factor_ * limited_at(p, greatest_) : factor_ * greatest_; }
  // The same as length <= at(p), but faster: it looks only for sources that limit the size to less than the length.
  bool is_at_least(double length, const Vec3& p) const {
    if (length <= least()) return true;
    if (!(length <= greatest())) return false;
    const double unscaled = length / factor_;
    return limited_at(p, unscaled) >= unscaled;
  }
  double greatest() const { return factor_ * greatest_; }
  // Lower bounds: everywhere, and within `reach` of a place where the length is `here`.
  double least() const { return factor_ * least_; }
  double least_near(double here, double reach) const;
  bool is_uniform() const { return known_ == nullptr; }

  friend SizeField operator*(double factor, SizeField field) {
    field.factor_ *= factor;
    return field;
  }

 private:
  struct Known;

  // The size at p, or `most` if the size is no less.
  double limited_at(const Vec3& p, double most) const;

  double greatest_, least_, factor_ = 1;
  std::shared_ptr<const Known> known_;  // null: the same size everywhere
};

}  // namespace hexpipe::tetmesh::sizing
