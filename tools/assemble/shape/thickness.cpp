// A ray walks from tet to tet and leaves each through the facet whose plane it meets first.

#include <algorithm>
#include <limits>

#include "common/mesh/cell_topology.hpp"
#include "tools/assemble/shape/input_surface.hpp"

namespace hexpipe::assemble::shape {
namespace {

// By rounding a ray may go round in circles. One that passes more tets than this within a few edge lengths does.
constexpr int most_tets = 1000;

struct Facet {
  TetIndex tet;
  int number;
};

struct Exit {
  int facet;
  double distance;  // from where the ray starts
};

class RayWalk {
 public:
  RayWalk(const TetMesh& mesh, const TetAdjacency& adjacency) : mesh_(mesh), adjacency_(adjacency) {}

  // From the middle of a facet into its tet.
  double length(Facet entry, double reach) const;

 private:
  Vec3 corner(const Facet& facet, int i) const {
    return mesh_.points[mesh_.tets[facet.tet][TetTopology::triangles[facet.number][i]]];
  }
  Vec3 outward_normal(const Facet& facet) const {
    return cross(corner(facet, 1) - corner(facet, 0), corner(facet, 2) - corner(facet, 0));
  }
  Exit exit_of(const Facet& entry, const Vec3& from, const Vec3& along) const;
  bool goes_on(TetIndex tet, TetIndex beyond) const {
    return beyond != no_index && mesh_.tet_tags[beyond] == mesh_.tet_tags[tet];
  }

  const TetMesh& mesh_;
  const TetAdjacency& adjacency_;
};

Exit RayWalk::exit_of(const Facet& entry, const Vec3& from, const Vec3& along) const {
  Exit first{entry.number, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < 4; ++i) {
    if (i == entry.number) continue;
    const Facet facet{entry.tet, i};
    const Vec3 normal = outward_normal(facet);
    const double speed = dot(normal, along);
    if (speed <= 0) continue;
    const double distance = dot(normal, corner(facet, 0) - from) / speed;
    if (distance < first.distance) first = {i, distance};
  }
  return first;
}

double RayWalk::length(Facet entry, double reach) const {
  const Vec3 from = (corner(entry, 0) + corner(entry, 1) + corner(entry, 2)) * (1.0 / 3);
  const Vec3 normal = outward_normal(entry);
  const double area = norm(normal);
  if (!(area > 0)) return reach;
  const Vec3 inwards = normal * (-1 / area);
  for (int step = 0; step < most_tets; ++step) {
    const Exit exit = exit_of(entry, from, inwards);
    if (!(exit.distance < reach)) return reach;
    const TetIndex beyond = adjacency_.tet_beyond(entry.tet, exit.facet);
    if (!goes_on(entry.tet, beyond)) return std::max(exit.distance, 0.0);
    const auto back = std::ranges::find(adjacency_.tets_beyond(beyond), entry.tet);
    entry = {beyond, static_cast<int>(back - adjacency_.tets_beyond(beyond).begin())};
  }
  return reach;
}

// Calls visit(facet) for each facet of a tet that the triangle is: at most two.
template <class Visit>
void for_each_side(const TetMesh& mesh, const TetAdjacency& adjacency, const Triangle& triangle, Visit&& visit) {
  for (const TetIndex t : adjacency.tets_at(triangle[0])) {
    const Tet& tet = mesh.tets[t];
    const auto is_corner = [&](Vertex v) { return std::ranges::find(triangle, v) != triangle.end(); };
    if (std::ranges::count_if(tet, is_corner) != 3) continue;
    visit(Facet{t, static_cast<int>(std::ranges::find_if_not(tet, is_corner) - tet.begin())});
  }
}

}  // namespace

std::vector<double> thickness_behind(const TetMesh& mesh, const TetAdjacency& adjacency,
                                     std::span<const double> reach) {
  std::vector<double> result(reach.begin(), reach.end());
  const RayWalk walk(mesh, adjacency);
  for (std::size_t i = 0; i < result.size(); ++i)
    for_each_side(mesh, adjacency, mesh.triangles[i],
                  [&](const Facet& facet) { result[i] = std::min(result[i], walk.length(facet, reach[i])); });
  return result;
}

}  // namespace hexpipe::assemble::shape
