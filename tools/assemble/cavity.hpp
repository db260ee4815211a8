#pragma once
// A cavity: tets around the diagonal of an open quad, to be replaced by a pyramid on the quad and tets on the rest of
// the cavity's skin, all joined to one new vertex.

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/assemble/hybrid_mesh.hpp"
#include "tools/assemble/point_star.hpp"
#include "tools/assemble/surface_tags.hpp"

namespace hexpipe {

class Cavity {
 public:
  enum class Obstacle { none, surface, cells };

  // The ring of tets around diagonal `diagonal` of `quad`, whose normal points into the ring.
  Cavity(const HybridMesh& mesh, const SurfaceTags& tags, const Quad& quad, int diagonal);

  // What keeps the ring from being a ball that shows the whole quad: the diagonal lies on a tagged surface, or other
  // cells use it.
  Obstacle obstacle() const { return obstacle_; }

  // Looks for the best place of the new vertex. While the worst element is below `enough`, tries to take in the tets
  // behind the worst facets. Returns the quality of the worst new element; not positive when no place is valid.
  double place_vertex(double enough);

  // Replaces the tets by the new elements; returns the new pyramid.
  std::int32_t fill(HybridMesh& mesh) const;

 private:
  struct Facet {
    Triangle triangle;  // outward
    std::int32_t tet;   // inside
  };

  bool collect_skin();
  bool is_sphere() const;
  void build_star();
  std::vector<Plane> planes() const;
  Placement search(int steps);
  std::vector<std::pair<double, Facet>> worst_facets(const Vec3& at) const;
  bool take_in(const Facet& facet);

  const HybridMesh& mesh_;
  const SurfaceTags& tags_;
  Quad quad_;
  int diagonal_;
  std::int32_t region_ = 0;
  Obstacle obstacle_ = Obstacle::none;
  std::vector<std::int32_t> tets_;
  std::vector<Facet> skin_;  // without the quad
  PointStar star_;
  Vec3 at_{};
};

}  // namespace hexpipe
