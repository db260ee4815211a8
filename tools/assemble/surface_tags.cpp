#include "tools/assemble/surface_tags.hpp"

namespace hexpipe {

SurfaceTags::SurfaceTags(const TetMesh& mesh) : mesh_(mesh) {
  triangles_.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    triangles_.try_emplace(key_of(mesh.triangles[i]), static_cast<std::int32_t>(i));
}

std::optional<std::int32_t> SurfaceTags::find(const Triangle& triangle) const {
  const auto found = triangles_.find(key_of(triangle));
  if (found == triangles_.end()) return std::nullopt;
  return found->second;
}

std::optional<SurfaceTags::Cover> SurfaceTags::cover_of(const Quad& quad, int diagonal) const {
  const auto halves = triangles_of(quad, diagonal);
  const auto first = find(halves[0]), second = find(halves[1]);
  if (!first || !second || tag_of(*first) != tag_of(*second)) return std::nullopt;
  return Cover{{*first, *second}};
}

std::optional<SurfaceTags::Cover> SurfaceTags::cover_of(const Quad& quad) const {
  if (const auto cover = cover_of(quad, 0)) return cover;
  return cover_of(quad, 1);
}

bool SurfaceTags::covers_partly(const Quad& quad, int diagonal) const {
  const auto halves = triangles_of(quad, diagonal);
  return (contains(halves[0]) || contains(halves[1])) && !cover_of(quad, diagonal);
}

}  // namespace hexpipe
