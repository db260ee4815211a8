#pragma once
// A cavity: tets that give way to tets between the facets of the cavity's skin and one new vertex. Around the diagonal
// of an open quad, a pyramid on the quad is among the new elements.

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
  Cavity(const hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, TetIndex tet);

  // Why the ring is no ball with the whole quad on its skin: the diagonal lies on a tagged surface, or other cells use
  // it.
  Obstacle obstacle() const { return obstacle_; }

  // Finds the best place for the new vertex. While the worst element is below `enough`, tries to take in the tets
  // behind the worst facets. Returns the quality of the worst new element, which is not positive if no place is valid.
  double place_vertex(double enough);

  // The quality of the worst tet that split() would remove.
  double worst_tet() const;

  // Replaces the tets by the new elements.
  void split(hybrid::HybridMesh& mesh) const;

 private:
  struct Facet {
    Triangle triangle;  // outward
    TetIndex tet;       // inside
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
  std::vector<TetIndex> tets_;
  std::vector<Facet> skin_;  // without the quad
  shape::PointStar star_;
  Vec3 at_{};
};

}  // namespace hexpipe::assemble::conform
