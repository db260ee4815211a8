#include "tools/tetmesh/asked_sizes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "common/run/error.hpp"
#include "tools/tetmesh/tetgen/build_mesh.hpp"

namespace hexpipe::tetmesh {
namespace {

constexpr std::size_t most_listed = 12;  // names in a message

[[noreturn]] void expect_box(std::string_view text) {
  throw UsageError(
      fmt::format("expected a box by its lowest and its highest corner, as 'box 0,0,0,1,1,1=0.2', found '{}'", text));
}

// Reads "0,0,0,1,1,1".
std::array<Vec3, 2> parse_box(std::string_view numbers, std::string_view text) {
  std::array<double, 6> values{};
  const char* at = numbers.data();
  const char* const end = at + numbers.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    while (at != end && *at == ' ') ++at;
    const auto [behind, error] = std::from_chars(at, end, values[i]);
    if (error != std::errc() || !std::isfinite(values[i])) expect_box(text);
    at = behind;
    if (i + 1 < values.size() && (at == end || *at++ != ',')) expect_box(text);
  }
  const std::array<Vec3, 2> box{Vec3{values[0], values[1], values[2]}, Vec3{values[3], values[4], values[5]}};
  const bool is_full = box[0].x < box[1].x && box[0].y < box[1].y && box[0].z < box[1].z;
  if (at != end || !is_full) expect_box(text);
  return box;
}

using Names = std::map<std::int32_t, std::string>;

// For example "3 (inlet), 4 and 7 more".
std::string list_of(const std::set<std::int32_t>& tags, const Names& names) {
  std::string list;
  std::size_t listed = 0;
  for (const std::int32_t tag : tags) {
    if (listed++ == most_listed) return list + fmt::format(" and {} more", tags.size() - most_listed);
    const auto name = names.find(tag);
    list += fmt::format("{}{}", list.empty() ? "" : ", ", tag);
    if (name != names.end()) list += fmt::format(" ({})", name->second);
  }
  return list;
}

// The tags that have the name, or are the number.
std::set<std::int32_t> tags_named(const std::string& name, const std::set<std::int32_t>& tags, const Names& names,
                                  std::string_view kind) {
  std::set<std::int32_t> found;
  for (const std::int32_t tag : tags) {
    const auto known = names.find(tag);
    const bool is_named = known != names.end() && known->second == name;
    if (is_named || name == std::to_string(tag) || name == fmt::format("{}_{}", kind, tag)) found.insert(tag);
  }
  return found;
}

class SizeCollector {
 public:
  SizeCollector(const solid::Surface& surface, std::span<const AskedSize> asked, double tetgen_timeout,
                sizing::SizeDemand& demand)
      : surface_(surface), asked_(asked), tetgen_timeout_(tetgen_timeout), demand_(demand) {}

  void collect() {
    add_bodies();
    for (const AskedSize& asked : asked_) {
      if (asked.place == AskedSize::Place::surface) add_surface(asked);
      if (asked.place == AskedSize::Place::box) add_box(asked);
    }
  }

 private:
  double length_of(const AskedSize& asked) const { return sizing::element_size(surface_, asked.size); }
  // Gives all of the points the size. Returns the number of the first one.
  Vertex add_points(std::span<const Vec3> points, double size) {
    sizing::SizeSources& sources = demand_.sources;
    const auto first = static_cast<Vertex>(sources.points.size());
    sources.points.insert(sources.points.end(), points.begin(), points.end());
    sources.sizes.insert(sources.sizes.end(), points.size(), size);
    return first;
  }
  void add_surface(const AskedSize& asked);
  void add_box(const AskedSize& asked);
  void add_bodies();
  void add_tets(const TetMesh& tets, const std::map<std::int32_t, double>& size_of);
  TetMesh tets_of_bodies() const;

  const solid::Surface& surface_;
  std::span<const AskedSize> asked_;
  double tetgen_timeout_;
  sizing::SizeDemand& demand_;
};

void SizeCollector::add_surface(const AskedSize& asked) {
  const std::set<std::int32_t> all(surface_.tags.begin(), surface_.tags.end());
  const std::set<std::int32_t> tags = tags_named(asked.name, all, surface_.names.surfaces, "surface");
  if (tags.empty())
    throw DataError::at(surface_.name, "expected --size of a surface by its name or number, found '{}'; there are {}",
                        asked.name, list_of(all, surface_.names.surfaces));
  const double size = length_of(asked);
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
    if (!tags.contains(surface_.tags[t])) continue;
    const auto [a, b, c] = surface_.triangles[t];
    const Vertex first = add_points(std::array{surface_.points[a], surface_.points[b], surface_.points[c]}, size);
    demand_.sources.simplices.push_back({first, first + 1, first + 2, no_index});
  }
}

// A box becomes six tets around the diagonal from its lowest corner.
void SizeCollector::add_box(const AskedSize& asked) {
  const auto& [low, high] = asked.box;
  Vec3 least = surface_.points.front(), most = least;
  for (const Vec3& p : surface_.points) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  for (int axis = 0; axis < 3; ++axis)
    if (high[axis] < least[axis] || low[axis] > most[axis])
      throw DataError::at(surface_.name,
                          "expected --size in a box that meets the model, from {:g},{:g},{:g} to {:g},{:g},{:g}, found "
                          "'{}'",
                          least.x, least.y, least.z, most.x, most.y, most.z, asked.name);
  std::array<Vec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
  const Vertex first = add_points(corners, length_of(asked));
  for (const auto& [i, j] : {std::pair(1, 3), {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}})
    demand_.sources.simplices.push_back({first, first + i, first + j, first + 7});
}

// The bodies with less than the greatest size become places.
void SizeCollector::add_bodies() {
  std::map<std::int32_t, double> size_of;
  std::set<std::int32_t> all;
  for (std::int32_t region = 1; region <= surface_.region_count; ++region) all.insert(region);
  const double elsewhere = demand_.greatest;
  for (const AskedSize& asked : asked_) {
    if (asked.place != AskedSize::Place::body) continue;
    const std::set<std::int32_t> tags = tags_named(asked.name, all, surface_.names.regions, "region");
    if (tags.empty())
      throw DataError::at(surface_.name, "expected --size of a body by its name or number, found '{}'; there are {}",
                          asked.name, list_of(all, surface_.names.regions));
    for (const std::int32_t tag : tags) size_of[tag] = length_of(asked);
  }
  if (size_of.empty()) return;
  for (const auto& [region, size] : size_of) demand_.greatest = std::max(demand_.greatest, size);
  if (size_of.size() == all.size()) {
    demand_.greatest = 0;
    for (const auto& [region, size] : size_of) demand_.greatest = std::max(demand_.greatest, size);
  } else {
    for (const std::int32_t region : all) size_of.try_emplace(region, elsewhere);
  }
  std::erase_if(size_of, [&](const auto& known) { return known.second >= demand_.greatest; });
  if (!size_of.empty()) add_tets(tets_of_bodies(), size_of);
}

void SizeCollector::add_tets(const TetMesh& mesh, const std::map<std::int32_t, double>& size_of) {
  for (const auto& [region, size] : size_of) {
    const Vertex first = add_points(mesh.points, size);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto [a, b, c, d] = mesh.tets[t];
      if (mesh.tet_tags[t] == region) demand_.sources.simplices.push_back({first + a, first + b, first + c, first + d});
    }
  }
}

// The fewest tets that fill the bodies.
TetMesh SizeCollector::tets_of_bodies() const {
  constexpr std::uint64_t most_runs = 8;
  for (std::uint64_t run = 0;; ++run) {
    try {
      return tetgen::build_mesh(surface_, {},
                                tetgen::run_tetgen({.surface_points = surface_.points,
                                                    .triangles = surface_.triangles,
                                                    .interior_points = {},
                                                    .shuffle = run,
                                                    .strict = run + 1 == most_runs,
                                                    .names_intersecting = false},
                                                   tetgen_timeout_))
          .mesh;
    } catch (const tetgen::TetGenFailure&) {
      if (run + 1 == most_runs) throw;
    }
  }
}

}  // namespace

AskedSize parse_asked_size(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  const std::string_view place = text.substr(0, equals);
  const sizing::Length size = sizing::parse_length(text.substr(equals + 1));
  constexpr std::string_view body = "body ", box = "box ";
  if (place.starts_with(box))
    return {AskedSize::Place::box, std::string(place), parse_box(place.substr(box.size()), text), size};
  if (place.starts_with(body)) return {AskedSize::Place::body, std::string(place.substr(body.size())), {}, size};
  return {AskedSize::Place::surface, std::string(place), {}, size};
}

void add_asked_sizes(const solid::Surface& surface, std::span<const AskedSize> asked, double tetgen_timeout,
                     sizing::SizeDemand& demand) {
  SizeCollector(surface, asked, tetgen_timeout, demand).collect();
}

}  // namespace hexpipe::tetmesh
