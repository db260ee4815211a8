#include "tools/assemble/hybrid/surface_tags.hpp"

#include <algorithm>

namespace hexpipe::assemble::hybrid {
namespace {

// Boundary facets that no triangle of the input names get this tag, as in findhex.
constexpr std::int32_t untagged = 0;

bool is_facet_of_a_tet(const Triangle& triangle, const TetMesh& mesh, const TetAdjacency& adjacency) {
  for (const TetIndex t : adjacency.tets_at(triangle[0])) {
    const Tet& tet = mesh.tets[t];
    auto has = [&](Vertex v) { return tet[0] == v || tet[1] == v || tet[2] == v || tet[3] == v; };
    if (has(triangle[1]) && has(triangle[2])) return true;
  }
  return false;
}

}  // namespace

void complete_surface(TetMesh& mesh, const TetAdjacency& adjacency) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!is_facet_of_a_tet(mesh.triangles[i], mesh, adjacency)) continue;
    mesh.triangles[kept] = mesh.triangles[i];
    mesh.triangle_tags[kept++] = mesh.triangle_tags[i];
  }
  mesh.triangles.resize(kept);
  mesh.triangle_tags.resize(kept);
  add_missing_boundary_triangles(mesh, adjacency, untagged);
}

SurfaceTags::SurfaceTags(const TetMesh& mesh)
    : triangles_(mesh.triangles), tags_(mesh.triangle_tags), is_on_any_(mesh.points.size()) {
  numbers_.reserve(triangles_.size());
  for (const Triangle& triangle : triangles_)
    for (const Vertex v : triangle) is_on_any_[v] = true;
  for (const auto i : indices<TaggedTriangle>(triangles_.size())) numbers_.try_emplace(key_of(triangles_[i]), i);
}

void SurfaceTags::peel(const Tet& tet, const std::array<TaggedTriangle, 2>& places,
                       const std::array<Triangle, 2>& triangles) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    numbers_.erase(key_of(triangles_[places[i]]));
    triangles_[places[i]] = triangles[i];
    numbers_.emplace(key_of(triangles[i]), places[i]);
  }
  peeled_.push_back(tet);
}

void SurfaceTags::merge(Vertex from, Vertex into, std::span<const TaggedTriangle> places,
                        std::span<const Tet> between) {
  for (const TaggedTriangle place : places) numbers_.erase(key_of(triangles_[place]));
  for (const TaggedTriangle place : places) {
    Triangle& triangle = triangles_[place];
    if (std::ranges::find(triangle, into) != triangle.end()) continue;
    std::ranges::replace(triangle, from, into);
    numbers_.emplace(key_of(triangle), place);
  }
  merges_.push_back({from, into});
  peeled_.insert(peeled_.end(), between.begin(), between.end());
}

std::optional<TaggedTriangle> SurfaceTags::find(const Triangle& triangle) const {
  if (!is_on_surface(triangle)) return std::nullopt;
  const auto found = numbers_.find(key_of(triangle));
  if (found == numbers_.end()) return std::nullopt;
  return found->second;
}

std::optional<SurfaceTags::Cover> SurfaceTags::cover_of(const Quad& quad, int diagonal) const {
  const auto halves = triangles_of(quad, diagonal);
  const auto first = find(halves[0]), second = find(halves[1]);
  if (!first || !second || tag_of(*first) != tag_of(*second)) return std::nullopt;
  return Cover{{*first, *second}};
}

std::optional<SurfaceTags::Cover> SurfaceTags::cover_of(const Quad& quad) const {
  if (!is_on_surface(quad)) return std::nullopt;
  if (const auto cover = cover_of(quad, 0)) return cover;
  return cover_of(quad, 1);
}

bool SurfaceTags::covers_partly(const Quad& quad, int diagonal) const {
  const auto halves = triangles_of(quad, diagonal);
  return (contains(halves[0]) || contains(halves[1])) && !cover_of(quad, diagonal);
}

BoundaryQuads::BoundaryQuads(const TetMesh& mesh, const TetAdjacency& adjacency, const SurfaceTags& tags)
    : tags_(tags), is_outer_(tags.size()) {
  for_each_boundary_facet(mesh, adjacency, [&](const Triangle& facet) {
    if (const auto triangle = tags.find(facet)) is_outer_[*triangle] = true;
  });
}

bool BoundaryQuads::contains(const Quad& quad) const {
  const auto cover = tags_.cover_of(quad);
  return cover && is_outer_[cover->triangles[0]];
}

}  // namespace hexpipe::assemble::hybrid
