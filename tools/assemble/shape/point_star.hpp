#pragma once
// The quality of the elements around one vertex as a function of where it stands, and the search for its best place.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/lanes.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe::assemble::shape {

// How much the corners of an element count beside those of others.
struct CornerRules {
  double weight = 1;  // factor on the scaled Jacobian: below 1, the element counts as worse and gets room sooner
  double share = 1;   // of its corners in the mean
  double enough = 1;  // the mean counts higher values as this one
  double floor = -1;  // keep_floors() lets no value fall below this
};

// A hex has a larger share in the mean, as its weight makes it the worst sooner.
constexpr CornerRules rules_of_hex(double weight) {
  return {.weight = weight, .share = 1 / (weight * weight), .floor = least_hex_quality};
}

// The corners of elements whose scaled Jacobian depends on one vertex, and a pull on this vertex. A corner at o with
// edges to a, b, c has det(a-o, b-o, c-o) / (|a-o| |b-o| |c-o|); for a tet times the square root of 2, so that the
// regular tet has 1.
class PointStar {
 public:
  void clear() { terms_.clear(), at_ends_.clear(), at_corners_.clear(), pull_ = {}; }
  bool empty() const { return terms_.empty(); }
  // Adds the corners of an element that involve its corner `moving`. The position given for that one is not used.
  void add(CellKind kind, std::span<const Vec3> corners, int moving, const CornerRules& rules = {});
  // The score rises by `pull` for each unit of length away from `start` along it.
  void set_pull(const Vec3& start, const Vec3& pull) { start_ = start, pull_ = pull; }
  const Vec3& pull() const { return pull_; }

  std::size_t size() const { return terms_.size(); }
  // The value of each corner, in the order in which they were added, and how it changes with the place; into lists
  // whose memory is used again.
  void find_values(const Vec3& at, std::vector<double>& values) const;
  void find_gradients(const Vec3& at, std::vector<Vec3>& gradients) const;
  double weight(std::size_t term) const { return terms_[term].weight; }
  double mean_share(std::size_t term) const { return terms_[term].mean_share; }
  // Whether the mean would not count a higher value than this one of the corner.
  bool is_enough(std::size_t term, double value) const { return value / weight(term) >= terms_[term].enough; }
  // The least value over all corners.
  double worst(const Vec3& at) const;

  // All that is asked about a place, from one look at each corner; the least value weighted and unweighted.
  struct Measures {
    Vec3 at{};
    std::vector<double> values{};  // by corner
    double worst = 0, worst_unweighted = 0;
    double mean = 0;  // of the unweighted values, by share
  };
  // Into `measures`, whose memory is used again.
  void measure(const Vec3& at, Measures& measures) const;
  Measures measured(const Vec3& at) const;
  // The mean plus the pull.
  double score_of(const Measures& measures) const { return measures.mean + dot(pull_, measures.at - start_); }
  // Whether worst(at) > bound; stops at the first corner that is not above it. Fills `values` with what it has seen.
  bool exceeds(const Vec3& at, double bound, std::vector<double>& values) const;
  // False if the move takes a value below its floor, or further below it.
  bool keeps_floors(const Vec3& before, const Vec3& at) const;
  bool keeps_floors(const Measures& before, const Measures& after) const;

 private:
  bool is_below_floor(std::size_t term, double value) const { return value < weight(term) * terms_[term].floor; }

  struct Term {
    double weight, mean_share, enough, floor;
  };
  // Corners whose formula is the same, as many as there are lanes; `terms` has the numbers of the first `count`.
  struct Block {
    std::array<std::int32_t, lane_count> terms{};
    int count = 0;
  };
  // The moving vertex is one of the neighbours of `corner`, and `normal` is the cross product of the unit edges to the
  // other two.
  struct alignas(lane_bytes) EndBlock : Block {
    LaneVector corner, normal;
    Lanes scale{};  // the weight, for a tet times the square root of 2
  };
  // The moving vertex is the corner itself.
  struct alignas(lane_bytes) CornerBlock : Block {
    std::array<LaneVector, 3> neighbours;
    Lanes scale{};
  };
  // Formulas for all lanes of a block.
  struct Formulas;

  void add_corner(std::span<const Vec3> corners, const LocalCorner& corner, int moving, const Term& term, double scale);
  template <class OneBlock>
  static int next_lane(std::vector<OneBlock>& blocks, std::size_t term);

  std::vector<Term> terms_;
  std::vector<EndBlock> at_ends_;
  std::vector<CornerBlock> at_corners_;
  Vec3 start_{}, pull_{};
};

// Where a vertex may go from where it is: anywhere, in a plane with this normal, along a line, or nowhere.
struct Freedom {
  enum class Kind { space, plane, line, none };
  Kind kind = Kind::space;
  Vec3 axis{};  // unit normal of the plane, or unit direction of the line

  Vec3 allowed(const Vec3& direction) const;
};

struct Placement {
  Vec3 at;
  double worst;
};

// Climbs from `start`, in at most `steps` steps, to a local maximum of the least scaled Jacobian around the vertex.
// Elements may be inverted at the start.
Placement raise_worst(const PointStar& star, const Vec3& start, int steps, const Freedom& freedom = {});

// Takes at most `steps` steps that raise the score, none of which takes the least value, weighted or unweighted, below
// `floor`.
Placement raise_score(const PointStar& star, const PointStar::Measures& start, int steps, double floor,
                      const Freedom& freedom = {});

// A plane with its unit normal; points on the normal's side have positive distance.
struct Plane {
  Vec3 normal;
  double offset;

  static Plane through(const Vec3& a, const Vec3& b, const Vec3& c);
  double distance(const Vec3& at) const { return dot(normal, at) - offset; }
};

// Climbs from `start` towards the point whose least distance from the planes is greatest. It lies in their kernel, if
// they have one.
Vec3 deepest_point(std::span<const Plane> planes, const Vec3& start);

// Approximately the point of the convex hull of `vectors` (not empty) that is nearest to the origin.
Vec3 shortest_in_hull(std::span<const Vec3> vectors);

}  // namespace hexpipe::assemble::shape
