#pragma once
// The triangulated quads of a mesh: docs/definitions.md 1, rules 2 and 8.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "tools/findhex/vertex_links.hpp"

namespace hexpipe {

// Rule 8 is broken by the quad abcd with diagonal ac: the normals of abc and acd do not agree.
inline bool is_folded(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 diagonal = c - a;
  return !(dot(cross(b - a, diagonal), cross(diagonal, d - a)) > 0);
}

// Which quads can be part of a candidate.
struct QuadFilter {
  double min_quality;  // the sine of no angle may be below: it bounds the scaled Jacobian there
  bool drop_folded;    // rule 8; where the mesh has both diagonals, one of them has to hold it
};

// Three corners of a quad, and rule 2 for the fourth: one diagonal leads from the corner to a vertex that is linked to
// both sides; the other one joins the sides, and the vertex is at one more facet with it. Rule 8 is not judged here.
class QuadAngle {
 public:
  QuadAngle() = default;
  // The sides as places among the neighbours of the corner.
  QuadAngle(const VertexLinks& links, Vertex corner, int place, int other_place)
      : corner_(corner),
        side_(links.neighbours_of(corner)[place]),
        other_side_(links.neighbours_of(corner)[other_place]),
        place_(place),
        other_place_(other_place),
        sides_are_linked_(links.are_linked(corner, place, other_place)) {}

  bool has_opposite(const VertexLinks& links) const {
    return links.have_common_link(corner_, place_, other_place_) ||
           (sides_are_linked_ && links.link_count_exceeds_one(side_, links.place_of(other_side_, side_)));
  }
  bool has_opposite(const VertexLinks& links, Vertex opposite) const {
    if (const int place = links.place_of(opposite, corner_); place != VertexLinks::none &&
                                                             links.are_linked(corner_, place_, place) &&
                                                             links.are_linked(corner_, other_place_, place))
      return true;
    return sides_are_linked_ && links.is_facet(side_, other_side_, opposite);
  }
  // Replaces `found` by the vertices opposite, ascending.
  void find_opposites(const VertexLinks& links, std::vector<Vertex>& found) const;

 private:
  Vertex corner_ = 0, side_ = 0, other_side_ = 0;
  int place_ = 0, other_place_ = 0;  // of the sides among the neighbours of the corner
  bool sides_are_linked_ = false;
};

// Rules 2 and 8 for the quad with these vertices in a cycle, not all diagonals of which may be there.
bool has_unfolded_diagonal(const TetMesh& mesh, const VertexLinks& links, Vertex a, Vertex b, Vertex c, Vertex d);

// The quads of which one vertex is the least, found once and used by all cells that have it as corner 0.
class QuadFan {
 public:
  QuadFan(const TetMesh& mesh, const VertexLinks& links, const QuadFilter& filter)
      : mesh_(mesh), links_(links), filter_(filter) {}

  // Two neighbours of the vertex that lie beside it in some quads, as one sees the other.
  struct Partner {
    int place;                // of the other among the neighbours of the vertex
    std::int32_t begin, end;  // of the quads' fourth vertices
  };

  // Finds the quads of this vertex.
  void find(Vertex least);

  // Ascending by place.
  std::span<const Partner> partners_of(int place) const {
    return std::span(partners_).subspan(offsets_[place], offsets_[place + 1] - offsets_[place]);
  }
  // The vertices opposite the least one in quads where it lies between these two neighbours; ascending.
  std::span<const Vertex> opposites(int place, int other_place) const;
  std::size_t size() const { return opposites_.size(); }

 private:
  struct Pair {
    int place, other_place;
    std::int32_t begin, end;
  };
  void find_between(Vertex least, int place, int other_place);
  void file_pairs(std::size_t neighbour_count);
  bool is_wanted(Vertex least, Vertex side, Vertex opposite, Vertex other_side) const;
  bool angle_suffices(const Vec3& u, const Vec3& v) const;

  const TetMesh& mesh_;
  const VertexLinks& links_;
  const QuadFilter filter_;
  std::vector<Vertex> opposites_;
  std::vector<Pair> pairs_;            // place < other_place, ascending
  std::vector<std::int32_t> offsets_;  // neighbours + 1
  std::vector<Partner> partners_;
  std::vector<Vertex> found_;
};

}  // namespace hexpipe
