#pragma once
// A cavity: tets to be replaced by tets on the facets of the cavity's skin, all joined to one new vertex; around the
// diagonal of an open quad also by a pyramid on the quad.

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::conform {

class Cavity {
 public:
  enum class Obstacle { none, surface, cells };

  // The ring of tets around diagonal `diagonal` of `quad`, whose normal points into the ring.
  Cavity(const hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, const Quad& quad, int diagonal);

  // One tet, to be improved; it grows in place_vertex.
  Cavity(const hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, std::int32_t tet);

  // What keeps the ring from being a ball that shows the whole quad: the diagonal lies on a tagged surface, or other
  // cells use it.
  Obstacle obstacle() const { return obstacle_; }

  // Looks for the best place of the new vertex. While the worst element is below `enough`, tries to take in the tets
  // behind the worst facets. Returns the quality of the worst new element; not positive when no place is valid.
  double place_vertex(double enough);

  // The quality of the worst tet that fill() would remove.
  double worst_tet() const;

  // Replaces the tets by the new elements.
  void fill(hybrid::HybridMesh& mesh) const;

 private:
  struct Facet {
    Triangle triangle;  // outward
    std::int32_t tet;   // inside
  };

  bool collect_skin();
  bool is_sphere() const;
  void build_star();
  std::vector<shape::Plane> planes() const;
  shape::Placement search(int steps) const;
  std::vector<std::pair<double, Facet>> worst_facets(const Vec3& at) const;
  bool take_in(const Facet& facet);

  const hybrid::HybridMesh& mesh_;
  const hybrid::SurfaceTags& tags_;
  std::optional<Quad> quad_;
  int diagonal_ = 0;
  std::int32_t region_ = 0;
  Obstacle obstacle_ = Obstacle::none;
  std::vector<std::int32_t> tets_;
  std::vector<Facet> skin_;  // without the quad
  shape::PointStar star_;
  Vec3 at_{};
};

}  // namespace hexpipe::assemble::conform
