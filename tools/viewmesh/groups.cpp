#include "tools/viewmesh/groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tools/viewmesh/facets.hpp"

namespace hexpipe::viewmesh {
namespace {

std::array<std::int32_t, 3> sorted(std::array<std::int32_t, 3> key) {
  std::sort(key.begin(), key.end());
  return key;
}

std::vector<Group> groups_of(std::vector<std::int32_t> tags, const std::map<std::int32_t, std::string>& names,
                             const char* kind) {
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  std::vector<Group> groups;
  groups.reserve(tags.size());
  for (const std::int32_t tag : tags) {
    const auto name = names.find(tag);
    groups.push_back({tag, name == names.end() ? fmt::format("{}_{}", kind, tag) : name->second});
  }
  return groups;
}

class TagLookup {
 public:
  TagLookup(std::vector<TaggedTriangle> triangles, std::size_t points)
      : triangles_(std::move(triangles)), tagged_point_(points) {
    std::sort(triangles_.begin(), triangles_.end(),
              [](const TaggedTriangle& a, const TaggedTriangle& b) { return a.key < b.key; });
    for (const TaggedTriangle& triangle : triangles_)
      for (const std::int32_t vertex : triangle.key) tagged_point_[vertex] = true;
  }

  // The tag of a facet; null when it is on no surface.
  const std::int32_t* tag_of(const FacetCorners& facet) const {
    const auto& v = facet.vertices;
    // Nearly all facets end here: they have a point inside.
    for (int i = 0; i < facet.count; ++i)
      if (!tagged_point_[v[i]]) return nullptr;
    if (const auto* tag = find({v[0], v[1], v[2]}); tag || facet.count == 3) return tag;
    if (const auto* tag = find({v[0], v[2], v[3]})) return tag;
    if (const auto* tag = find({v[0], v[1], v[3]})) return tag;
    return find({v[1], v[2], v[3]});
  }

 private:
  const std::int32_t* find(std::array<std::int32_t, 3> vertices) const {
    const auto key = sorted(vertices);
    const auto found = std::lower_bound(triangles_.begin(), triangles_.end(), key,
                                        [](const TaggedTriangle& a, const auto& b) { return a.key < b; });
    return found != triangles_.end() && found->key == key ? &found->tag : nullptr;
  }

  std::vector<TaggedTriangle> triangles_;
  std::vector<bool> tagged_point_;
};

}  // namespace

void append_tagged(const std::vector<std::array<std::int32_t, 3>>& triangles, const std::vector<std::int32_t>& tags,
                   std::vector<TaggedTriangle>& all) {
  for (std::size_t i = 0; i < triangles.size(); ++i) all.push_back({sorted(triangles[i]), tags[i]});
}

void append_tagged(const std::vector<std::array<std::int32_t, 4>>& quads, const std::vector<std::int32_t>& tags,
                   std::vector<TaggedTriangle>& all) {
  for (std::size_t i = 0; i < quads.size(); ++i)
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::array<std::int32_t, 3> key{};
      for (std::size_t k = 0; k < 3; ++k) key[k] = quads[i][(left_out + 1 + k) % 4];
      all.push_back({sorted(key), tags[i]});
    }
}

void find_groups(const formats::GroupNames& names, std::vector<TaggedTriangle> triangles, Scene& scene) {
  std::vector<std::int32_t> tags;
  tags.reserve(triangles.size());
  for (const TaggedTriangle& triangle : triangles) tags.push_back(triangle.tag);
  scene.regions = groups_of(scene.region, names.regions, "region");
  scene.surfaces = groups_of(std::move(tags), names.surfaces, "surface");
  const TagLookup lookup(std::move(triangles), scene.points.size());
  for (std::int32_t cell = 0; cell < scene.cell_count(); ++cell)
    for (int facet = 0; facet < facet_count(scene.kind_of(cell)); ++facet)
      if (const auto* tag = lookup.tag_of(facet_corners(scene, cell, facet)))
        scene.surface_facets.push_back({cell, facet, static_cast<std::int32_t>(place_of(scene.surfaces, *tag))});
}

}  // namespace hexpipe::viewmesh
