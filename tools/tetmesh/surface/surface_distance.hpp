#pragma once
// How far two surfaces are from each other, measured both ways.

#include <cmath>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"

namespace hexpipe::tetmesh::surface {

// Finds distances from a fixed set of triangles.
class DistanceIndex {
 public:
  // The arrays must outlive the index.
  DistanceIndex(std::span<const Vec3> points, std::span<const Triangle> triangles);

  // `nearest` is a guess of the nearest triangle, or no_index, and becomes the nearest triangle. A good guess saves
  // most of the work. So does `enough`: a triangle that is no further away than that is taken without looking for a
  // nearer one.
  double distance(const Vec3& p, std::int32_t& nearest, double enough = 0) const;
  double distance(const Vec3& p) const {
    std::int32_t nearest = no_index;
    return distance(p, nearest);
  }

 private:
  struct Cell {
    std::int64_t x, y, z;
  };
  Cell cell_of(const Vec3& p) const;
  std::int64_t number_of(const Cell& c) const { return (c.z * counts_.y + c.y) * counts_.x + c.x; }
  double margin_in(const Cell& cell, const Vec3& p) const;
  // The nearest triangle so far with its distance and the square of that, and the square of `enough`.
  struct Search {
    std::int32_t nearest;
    double best, distance, enough;
    bool is_done() const { return best <= enough; }
    void take(std::int32_t triangle, double squared) {
      nearest = triangle;
      best = squared;
      distance = std::sqrt(squared);
    }
  };
  void look_in_shell(const Vec3& p, const Cell& centre, std::int64_t ring, Search& search) const;
  void look_in_cell(const Vec3& p, const Cell& cell, Search& search) const;
  double squared_to_box(const Vec3& p, const Cell& cell) const;
  template <class Visit>
  void for_each_cell(const Triangle& t, Visit&& visit) const;

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  struct Bounds {
    Vec3 corner;    // the first
    Vec3 normal;    // of length 1
    double radius;  // of a ball around the corner that holds the triangle
  };
  std::vector<Bounds> bounds_;  // of the triangles
  Vec3 low_;
  double width_;
  Cell counts_{};
  std::vector<std::uint32_t> offsets_;  // by cell, of its members
  std::vector<std::int32_t> members_;
};

struct SurfaceDistance {
  double greatest = 0;       // over samples at most `spacing` apart
  std::vector<Vec3> beyond;  // samples further away than the limit
};

// Distances from samples of one surface, with its vertices among them, to another surface.
SurfaceDistance one_sided_distance(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                   const DistanceIndex& other, const sizing::SizeField& spacing,
                                   const sizing::SizeField& limit);

}  // namespace hexpipe::tetmesh::surface
