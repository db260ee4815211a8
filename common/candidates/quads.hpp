#pragma once
// The triangulated quads of a mesh: docs/definitions.md 1, rules 2 and 8.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "common/candidates/vertex_links.hpp"
#include "common/mesh/lanes.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::candidates {

// The quad abcd with diagonal ac breaks rule 8: the normals of abc and acd disagree.
inline bool is_folded(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 diagonal = c - a;
  return !(dot(cross(b - a, diagonal), cross(diagonal, d - a)) > 0);
}

// Which quads may be part of a candidate.
struct QuadFilter {
  double min_quality;  // for the sine of each angle, which bounds the scaled Jacobian there
  bool drop_folded;    // rule 8; if the mesh has both diagonals, one of them has to obey it
};

// The diagonals, as bits, for which both triangles of a quad are in the mesh; seen from one of its corners.
using Diagonals = std::uint8_t;
inline constexpr Diagonals from_corner = 1, between_sides = 2;

// A possible fourth corner of a quad.
struct OppositeCorner {
  Vertex vertex;
  Diagonals diagonals;
};

// Three corners of a quad, and rule 2 for the fourth. Either a diagonal joins the corner to a vertex that is linked to
// both sides, or the diagonal joins the sides, and the vertex is on another facet with it. Rule 8 is not judged here.
class QuadAngle {
 public:
  QuadAngle() = default;
  // The sides are given by their places among the neighbours of the corner.
  QuadAngle(const VertexLinks& links, Vertex corner, int place, int other_place);

  bool has_opposite(const VertexLinks& links) const {
    return is_narrow_ ? along_ != 0 || (between_ & (between_ - 1)) != 0 : has_opposite_among_many(links);
  }
  bool has_opposite(const VertexLinks& links, Vertex opposite) const {
    if (!is_narrow_) return has_opposite_among_many(links, opposite);
    const auto is_linked = [&](std::uint64_t linked, Vertex v) {
      if (linked == 0) return false;
      const int place = links.place_of(opposite, v);
      return place != no_index && (linked >> place & 1) != 0;
    };
    return is_linked(along_, corner_) || is_linked(between_, side_);
  }
  // The number of opposite vertices, or one or two less; if a vertex has many neighbours, a greater number.
  int opposite_count() const { return is_narrow_ ? bit_count(along_) + bit_count(between_) : most; }
  // The opposite vertices, ascending. They are stored in `memory`.
  std::span<const OppositeCorner> find_opposites(const VertexLinks& links, std::vector<OppositeCorner>& memory) const;

 private:
  static constexpr int most = std::numeric_limits<int>::max();

  // Like std::popcount, which is a function call if not all processors have the instruction.
  static int bit_count(std::uint64_t bits) {
    constexpr std::uint64_t pairs = 0x3333333333333333, nibbles = 0x0f0f0f0f0f0f0f0f, bytes = 0x0101010101010101;
    bits -= bits >> 1 & 0x5555555555555555;
    bits = (bits & pairs) + (bits >> 2 & pairs);
    return static_cast<int>(((bits + (bits >> 4)) & nibbles) * bytes >> 56);
  }

  bool has_opposite_among_many(const VertexLinks& links) const;
  bool has_opposite_among_many(const VertexLinks& links, Vertex opposite) const;
  std::span<const OppositeCorner> find_among_many(const VertexLinks& links, std::vector<OppositeCorner>& memory) const;

  Vertex corner_ = 0, side_ = 0, other_side_ = 0;
  int place_ = 0, other_place_ = 0;  // of the sides, among the neighbours of the corner
  bool sides_are_linked_ = false;
  bool is_narrow_ = true;
  // along_: bits by place at the corner; set for vertices linked to both sides. between_: if the sides are linked, bits
  // by place at the side; set for vertices linked to the other side.
  std::uint64_t along_ = 0, between_ = 0;
};

// Rules 2 and 8 for the quad with these vertices in cyclic order. The first function allows that a diagonal is missing;
// the second gets the diagonals, seen from a.
bool has_unfolded_diagonal(const TetMesh& mesh, const VertexLinks& links, Vertex a, Vertex b, Vertex c, Vertex d);
bool has_unfolded_diagonal(const TetMesh& mesh, Diagonals diagonals, Vertex a, Vertex b, Vertex c, Vertex d);

// Up to 64 edges from one vertex, side by side. Lanes after the last edge hold any values.
struct alignas(lane_bytes) EdgeRow {
  static constexpr int most = 64;

  std::array<LaneVector, most / lane_count> vectors;
  std::array<Lanes, most / lane_count> squares;  // the squared lengths
  int size = 0;

  void add(const Vec3& vector, double square) {
    LaneVector& vectors_there = vectors[size / lane_count];
    const int lane = size % lane_count;
    vectors_there.x[lane] = vector.x;
    vectors_there.y[lane] = vector.y;
    vectors_there.z[lane] = vector.z;
    squares[size / lane_count][lane] = square;
    ++size;
  }
};

// The quads whose least vertex is the `first` one. They are found once, and all cells with this corner 0 use them. An
// outer edge is a side of such a quad that does not touch the first vertex.
class QuadFan {
 public:
  struct Quad {
    Vertex opposite;
    std::array<std::int32_t, 2> outer_edges;  // from its two sides, the lower one first, to the opposite vertex
    Diagonals diagonals;                      // seen from the first vertex
    std::array<std::uint8_t, 2> numbers{};    // of the outer edges at their sides
  };
  // Two neighbours of the first vertex that are beside it in some quads.
  struct Pair {
    std::array<int, 2> places;                   // among the neighbours of the first vertex, ascending
    std::int32_t begin, end;                     // of its quads
    std::array<std::uint64_t, 2> outer_edges{};  // of the quads at each of the two: bits by number
  };
  QuadFan(const TetMesh& mesh, const VertexLinks& links, const QuadFilter& filter)
      : mesh_(mesh), links_(links), filter_(filter) {}

  // Finds the quads of this vertex.
  void find(Vertex first);

  // The place at which the greater neighbours of the first vertex begin.
  int first_place() const { return first_place_; }
  // The greater neighbours are bits that begin with that place, 64 to a word.
  std::size_t word_count() const { return (spokes_.size() + 63) / 64; }
  // The neighbours that form a pair with this one.
  std::uint64_t partners_of(int place, std::size_t word) const {
    return partner_bits_[(place - first_place_) * word_count() + word];
  }
  // The neighbours at greater places.
  std::uint64_t greater_than(int place, std::size_t word) const {
    const int before = place + 1 - first_place_ - static_cast<int>(64 * word);
    return before >= 64 ? 0 : ~std::uint64_t{0} << std::max(before, 0);
  }
  // The neighbours for which rule 3 holds at the first vertex, when edges lead to two given neighbours and then to them
  // in the positive sense.
  std::uint64_t third_edges(int place, int next_place, std::size_t word) const;
  // The pair of these two neighbours, or nullptr if the first vertex is between them in no quad.
  const Pair* find_pair(int place, int other_place) const {
    if (spokes_.size() > most_tabled) return find_pair_among_many(place, other_place);
    const std::size_t spoke = place - first_place_, other_spoke = other_place - first_place_;
    const std::int32_t pair = pair_of_spokes_[spoke * spokes_.size() + other_spoke];
    return pair == no_index ? nullptr : &pairs_[pair];
  }
  // The quads of a pair, by ascending opposite vertex.
  std::span<const Quad> quads_of(const Pair& pair) const {
    return std::span(quads_).subspan(pair.begin, pair.end - pair.begin);
  }
  std::size_t size() const { return quads_.size(); }

  // The place of an outer edge's far end among the neighbours of its near end.
  int place_at_near_end(std::int32_t outer_edge) const { return outer_edges_[outer_edge].place; }

  // Rule 3 for a corner at a neighbour of the first vertex: its edges lead to the first vertex and along two outer
  // edges, in the positive sense.
  bool corner_suffices(std::int32_t outer_edge, std::int32_t next) const {
    const OuterEdge &a = outer_edges_[outer_edge], &b = outer_edges_[next];
    return b.number < most_numbered ? (a.suffices_before >> b.number & 1) != 0 : corner_suffices(a, b);
  }
  // Bits by number: the outer edges that fit (rule 3) after this one at their neighbour of the first vertex, or before
  // it. If there are more edges than bits, all are set and have number 0, and are_all_corners_judged() is false.
  std::uint64_t suffices_before(std::int32_t outer_edge) const { return outer_edges_[outer_edge].suffices_before; }
  std::uint64_t suffices_after(std::int32_t outer_edge) const { return outer_edges_[outer_edge].suffices_after; }
  bool are_all_corners_judged() const { return are_all_judged_; }

  // Whether rule 3 may hold for a corner with this outer edge and, as the next one (or the one before), an edge from
  // some quad of the pair. Both are at the same neighbour of the first vertex, which is at `side` of the pair.
  bool may_suffice_before(std::int32_t outer_edge, const Pair& pair, std::size_t side) const {
    return (outer_edges_[outer_edge].suffices_before & pair.outer_edges[side]) != 0;
  }
  bool may_suffice_after(std::int32_t outer_edge, const Pair& pair, std::size_t side) const {
    return (outer_edges_[outer_edge].suffices_after & pair.outer_edges[side]) != 0;
  }

 private:
  static constexpr std::size_t least_slots = 512;
  static constexpr int most_numbered = 64;
  static constexpr std::size_t most_tabled = 64;
  // An edge to a neighbour of the first vertex; the outer edges begin at that neighbour.
  struct Spoke {
    Vec3 vector;
    double square;  // of its length
    std::int32_t last = no_index;
    int count = 0;
  };
  struct OuterEdge {
    Vec3 vector;
    double square;
    Vertex end;
    int spoke;
    bool angle_suffices;                      // with the spoke
    int place = no_index, number = no_index;  // at the near end; among the spoke's outer edges that are in quads
    std::int32_t before = no_index;           // the spoke's outer edge with the previous number
    // Bits by number: the other edges that make a sufficient corner when the other one is next, or before. If the spoke
    // has more edges than bits, all are set, and the edges' numbers are most_numbered.
    std::uint64_t suffices_before = 0, suffices_after = 0;
  };

  void measure_spokes();
  void find_between(int place, int other_place);
  void table_pairs();
  const Pair* find_pair_among_many(int place, int other_place) const;
  bool is_wanted(const OuterEdge& edge, const OuterEdge& other_edge) const;
  bool angle_suffices(const Vec3& u, double u_square, const Vec3& v, double v_square) const;
  std::int32_t outer_edge(int place, Vertex end);
  std::size_t first_slot(int place, Vertex end) const;
  void widen_slots();
  void number_outer_edge(std::int32_t outer_edge);
  void judge_corners_at(const Spoke& spoke);
  void collect_outer_edges(Pair& pair);
  bool corner_suffices(const OuterEdge& edge, const OuterEdge& next) const;

  const TetMesh& mesh_;
  const VertexLinks& links_;
  const QuadFilter filter_;
  Vertex first_ = 0;
  int first_place_ = 0;
  bool are_all_judged_ = true;
  std::vector<Spoke> spokes_;        // by place, of the greater neighbours
  std::vector<EdgeRow> spoke_rows_;  // the same edges, 64 to a row
  std::vector<OuterEdge> outer_edges_;
  std::vector<std::int32_t> slots_;  // a hash table of outer edges, at most half full
  std::vector<Quad> quads_;
  std::vector<Pair> pairs_;                   // ascending by place
  std::vector<std::int32_t> pair_of_spokes_;  // by both spokes, if these are not too many
  std::vector<std::uint64_t> partner_bits_;   // word_count() words per spoke
  std::vector<OppositeCorner> found_;
  std::vector<std::int32_t> at_spoke_;  // outer edges, by number
  EdgeRow row_;                         // the same edges
};

}  // namespace hexpipe::candidates
