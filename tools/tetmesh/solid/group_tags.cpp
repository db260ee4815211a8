#include "tools/tetmesh/solid/group_tags.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "common/mesh/defaults.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/run/error.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

constexpr std::size_t most_tags_listed = 10;

// Finds for each triangle the first triangle of its component.
class SmoothComponents {
 public:
  SmoothComponents(const Surface& surface, double angle)
      : surface_(surface), cosine_(cosine_of_degrees(angle)), parent_(surface.triangles.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (const formats::CurveEdge& edge : surface.curves) curves_.insert(key_of(edge));
    geometry::for_each_edge(surface.points.size(), surface.triangles,
                            [&](std::span<const geometry::HalfEdge> edge) { add(edge); });
  }

  std::int32_t of(std::int32_t t) {
    while (parent_[t] != t) t = parent_[t] = parent_[parent_[t]];
    return t;
  }

 private:
  bool is_named(std::int32_t t) const { return surface_.names.surfaces.contains(surface_.tags[t]); }
  Vec3 normal(std::int32_t t) const {
    const auto [a, b, c] = surface_.triangles[t];
    return cross(surface_.points[b] - surface_.points[a], surface_.points[c] - surface_.points[a]);
  }

  void add(std::span<const geometry::HalfEdge> edge) {
    if (edge.size() != 2) return;
    const std::int32_t t = geometry::triangle_of(edge[0]), u = geometry::triangle_of(edge[1]);
    if (is_named(t) || is_named(u)) return;
    const Vec3 n = normal(t), m = normal(u);
    if (dot(n, m) < cosine_ * norm(n) * norm(m)) return;
    if (curves_.contains(
            edge_key(geometry::start_of(surface_.triangles, edge[0]), geometry::end_of(surface_.triangles, edge[0]))))
      return;
    const std::int32_t first = std::min(of(t), of(u));
    parent_[of(t)] = first;
    parent_[of(u)] = first;
  }

  const Surface& surface_;
  double cosine_;
  std::vector<std::int32_t> parent_;
  KeySet<2> curves_;
};

}  // namespace

void tag_by_angle(Surface& surface, double angle) {
  // A name that all triangles have tells nothing apart.
  if (std::ranges::adjacent_find(surface.tags, std::not_equal_to()) == surface.tags.end())
    surface.names.surfaces.clear();
  SmoothComponents components(surface, angle);
  std::vector<std::int32_t> tag_of_component(surface.triangles.size(), 0);
  std::int32_t last = 0;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    if (surface.names.surfaces.contains(surface.tags[i])) continue;
    std::int32_t& tag = tag_of_component[components.of(static_cast<std::int32_t>(i))];
    if (tag == 0) {
      do ++last;
      while (surface.names.surfaces.contains(last));
      tag = last;
    }
    surface.tags[i] = tag;
  }
}

TagName parse_tag_name(const std::string& text) {
  constexpr std::string_view region = "region ";
  TagName result;
  const std::size_t equals = text.find('=');
  std::string_view number = std::string_view(text).substr(0, std::min(equals, text.size()));
  result.of_region = number.starts_with(region);
  if (result.of_region) number.remove_prefix(region.size());
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), result.tag);
  if (equals != std::string::npos) result.name = formats::clean_name(std::string_view(text).substr(equals + 1));
  if (error != std::errc() || end != number.data() + number.size() || result.name.empty())
    throw UsageError(fmt::format("expected --name TAG=NAME or 'region TAG=NAME', found '{}'", text));
  return result;
}

void name_tags(Surface& surface, std::span<const TagName> names) {
  const std::set<std::int32_t> tags(surface.tags.begin(), surface.tags.end());
  for (const TagName& entry : names) {
    if (entry.of_region && (entry.tag < 1 || entry.tag > surface.region_count))
      throw DataError::at(surface.name, "expected --name of a region from 1 to {}, found {}", surface.region_count,
                          entry.tag);
    if (!entry.of_region && !tags.contains(entry.tag)) {
      const std::vector<std::int32_t> some(
          tags.begin(), std::next(tags.begin(), static_cast<std::ptrdiff_t>(std::min(most_tags_listed, tags.size()))));
      throw DataError::at(surface.name, "expected --name of a surface tag ({}{}), found {}", fmt::join(some, ", "),
                          tags.size() > most_tags_listed ? ", ..." : "", entry.tag);
    }
    (entry.of_region ? surface.names.regions : surface.names.surfaces)[entry.tag] = entry.name;
  }
}

}  // namespace hexpipe::tetmesh::solid
