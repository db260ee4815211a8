#include "tools/tetmesh/tetgen/build_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/cell_topology.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/run/error.hpp"

namespace hexpipe::tetmesh::tetgen {
namespace {

constexpr std::int32_t unknown_region = -1;
// A share of the volume inside all shells. The sum over ten million tets is off by about 1e-12 of it.
constexpr double volume_tolerance = 1e-9;

template <class... Args>
TetGenFailure failure_at(const std::string& place, fmt::format_string<Args...> text, Args&&... args) {
  return TetGenFailure(fmt::format("{}: TetGen failed: {}", place, fmt::format(text, std::forward<Args>(args)...)));
}

// Throws what TetGen says about its failure; if it names triangles, with the first one's place in the file.
[[noreturn]] void fail(const solid::Surface& surface, const TetGenResult& tetgen) {
  if (tetgen.intersecting.empty()) throw failure_at(surface.name, "{}", tetgen.failure);
  KeySet<3> named;
  for (const Triangle& t : tetgen.intersecting) named.insert(key_of(t));
  for (std::size_t i = 0; i < surface.triangles.size(); ++i)
    if (named.contains(key_of(surface.triangles[i])))
      throw failure_at(surface.place_of(i), "it found {} triangles that intersect; the first is here",
                       tetgen.intersecting.size());
  throw failure_at(surface.name, "{}", tetgen.failure);
}

void check_points(const solid::Surface& surface, const std::vector<Vec3>& points) {
  if (points.size() < surface.points.size() ||
      !std::equal(surface.points.begin(), surface.points.end(), points.begin()))
    throw failure_at(surface.name, "it moved or merged points of the surface");
}

void check_orientation(const solid::Surface& surface, const TetMesh& mesh) {
  const auto flat = static_cast<std::size_t>(
      std::ranges::count_if(mesh.tets, [&](const Tet& t) { return tet_determinant(mesh.points, t) <= 0; }));
  if (flat > 0) throw failure_at(surface.name, "{} of its {} tets have no volume", flat, mesh.tets.size());
}

// How many of `wanted` are in `found`, in the same order. Points that TetGen added come last.
std::size_t count_kept(std::span<const Vec3> wanted, std::span<const Vec3> found) {
  std::size_t kept = 0;
  for (const Vec3& p : wanted) kept += kept < found.size() && found[kept] == p;
  return kept;
}

// Finds the region of every tet. Tets at a surface triangle are on a known side of it; the others are reached from
// these without crossing the surface.
class RegionFinder {
 public:
  RegionFinder(const solid::Surface& surface, const TetMesh& mesh, const TetAdjacency& adjacency)
      : surface_(surface),
        mesh_(mesh),
        adjacency_(adjacency),
        regions_(mesh.tets.size(), unknown_region),
        on_surface_(mesh.tets.size()) {}

  std::vector<std::int32_t> find() {
    for (std::size_t i = 0; i < surface_.triangles.size(); ++i) place_beside(i);
    if (lost_ > 0)
      throw failure_at(surface_.place_of(first_lost_), "it lost {} triangles of the surface; the first is here", lost_);
    spread();
    return std::move(regions_);
  }

 private:
  void place_beside(std::size_t triangle);
  void place(TetIndex tet, std::int32_t region);
  void spread();

  const solid::Surface& surface_;
  const TetMesh& mesh_;
  const TetAdjacency& adjacency_;
  std::vector<std::int32_t> regions_;
  std::vector<std::array<bool, 4>> on_surface_;  // for each tet and facet
  std::vector<TetIndex> queue_;
  std::size_t lost_ = 0, first_lost_ = 0;
};

void RegionFinder::place_beside(std::size_t triangle) {
  const Triangle corners = surface_.triangles[triangle];
  const solid::Shell& shell = surface_.shells[surface_.shell_of[triangle]];
  bool found_behind = false, found_in_front = false;
  for (const TetIndex t : adjacency_.tets_at(corners[0])) {
    const Tet& tet = mesh_.tets[t];
    for (std::size_t facet = 0; facet < 4; ++facet) {
      Triangle outward;
      for (std::size_t i = 0; i < 3; ++i) outward[i] = tet[TetTopology::triangles[facet][i]];
      if (key_of(outward) != key_of(corners)) continue;
      std::rotate(outward.begin(), std::ranges::find(outward, corners[0]), outward.end());
      const bool is_behind = outward == corners;
      (is_behind ? found_behind : found_in_front) = true;
      on_surface_[t][facet] = true;
      place(t, is_behind ? shell.behind : shell.in_front);
    }
  }
  if (!found_behind || (shell.in_front != solid::outside_region && !found_in_front)) {
    if (lost_++ == 0) first_lost_ = triangle;
  }
}

void RegionFinder::place(TetIndex tet, std::int32_t region) {
  if (regions_[tet] == region) return;
  if (regions_[tet] != unknown_region)
    throw failure_at(surface_.name, "its tets join regions that the surface keeps apart");
  regions_[tet] = region;
  queue_.push_back(tet);
}

void RegionFinder::spread() {
  while (!queue_.empty()) {
    const TetIndex t = queue_.back();
    queue_.pop_back();
    for (int facet = 0; facet < 4; ++facet) {
      if (on_surface_[t][facet]) continue;
      const TetIndex beyond = adjacency_.tet_beyond(t, facet);
      if (beyond != no_index) {
        place(beyond, regions_[t]);
      } else if (regions_[t] != solid::outside_region) {
        throw failure_at(surface_.name, "its tets leave a gap behind the surface");
      }
    }
  }
}

// Keeps the tets that lie in a region, and the points that they use.
void empty_holes(TetMesh& mesh) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.tet_tags[t] == solid::outside_region) continue;
    mesh.tets[kept] = mesh.tets[t];
    mesh.tet_tags[kept] = mesh.tet_tags[t];
    ++kept;
  }
  mesh.tets.resize(kept);
  mesh.tet_tags.resize(kept);

  std::vector<Vertex> new_index(mesh.points.size(), 0);
  for (const Tet& tet : mesh.tets)
    for (const Vertex v : tet) new_index[v] = 1;
  Vertex used = 0;
  for (std::size_t v = 0; v < new_index.size(); ++v) {
    if (new_index[v] == 0) continue;
    mesh.points[used] = mesh.points[v];
    new_index[v] = used++;
  }
  mesh.points.resize(used);
  for (Tet& tet : mesh.tets)
    for (Vertex& v : tet) v = new_index[v];
}

void check_volumes(const solid::Surface& surface, const TetMesh& mesh) {
  const std::vector<double> wanted = surface.region_volumes();
  std::vector<double> found(wanted.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    found[mesh.tet_tags[t]] += tet_determinant(mesh.points, mesh.tets[t]) / 6;
  double scale = 0;
  for (const solid::Shell& shell : surface.shells) scale += surface.has_sheets ? 0 : shell.volume;
  if (surface.has_sheets) scale = surface.volume();
  for (std::size_t region = 1; region < wanted.size(); ++region)
    if (std::abs(found[region] - wanted[region]) > volume_tolerance * scale)
      throw failure_at(surface.name, "region {} has volume {:.12g}, its tets {:.12g}", region, wanted[region],
                       found[region]);
}

}  // namespace

BuiltMesh build_mesh(const solid::Surface& surface, std::span<const Vec3> interior_points, TetGenResult tetgen) {
  if (!tetgen.failure.empty()) fail(surface, tetgen);
  TetMesh mesh;
  mesh.points = std::move(tetgen.points);
  mesh.tets = std::move(tetgen.tets);
  check_points(surface, mesh.points);
  check_orientation(surface, mesh);
  TetAdjacency adjacency(mesh, surface.name.c_str());
  mesh.tet_tags = RegionFinder(surface, mesh, adjacency).find();
  if (std::ranges::find(mesh.tet_tags, solid::outside_region) != mesh.tet_tags.end()) {
    empty_holes(mesh);
    adjacency = TetAdjacency(mesh, surface.name.c_str());
  }
  check_points(surface, mesh.points);
  check_volumes(surface, mesh);
  mesh.triangles = surface.triangles;
  mesh.triangle_tags = surface.tags;

  const std::span off_surface = std::span<const Vec3>(mesh.points).subspan(surface.points.size());
  const std::size_t kept = count_kept(interior_points, off_surface);
  const std::size_t added = off_surface.size() - kept, dropped = interior_points.size() - kept;
  return {std::move(mesh), std::move(adjacency), added, dropped};
}

}  // namespace hexpipe::tetmesh::tetgen
