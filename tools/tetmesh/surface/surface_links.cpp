#include "tools/tetmesh/surface/surface_links.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/tetmesh/curl_correction.hpp"

namespace hexpipe {
namespace {

using Link = SurfaceLink;

class Linker {
 public:
  Linker(const FieldSurface& surface, const CrossField& field, std::span<const Vec3> centres,
         std::span<const double> sizes)
      : surface_(surface), field_(field), centres_(centres), sizes_(sizes), links_(surface.twins.size()) {}

  std::vector<Link> run() {
    make_links();
    correct_curl();
    return std::move(links_);
  }

 private:
  std::array<Vec3, 2> directions(std::int32_t f) const {
    const Vec3& x = field_.directions[f];
    return {x, cross(surface_.normals[f], x)};
  }
  void make_links();
  Link make_link(HalfEdge h) const;
  static void turn(Link& link);
  static Link reversed(const Link& link, std::int32_t from);
  void correct_curl();
  void add_loops(HalfEdge first, Loops& loops) const;
  static std::int32_t number_of(HalfEdge h, std::size_t axis) { return 2 * h + static_cast<std::int32_t>(axis); }
  // Calls body(h) for one half-edge of each pair with links.
  template <class Body>
  void for_each_pair(Body&& body) const {
    for (HalfEdge h = 0; h < static_cast<HalfEdge>(links_.size()); ++h)
      if (links_[h].neighbour >= 0 && h < surface_.twins[h]) body(h);
  }

  const FieldSurface& surface_;
  const CrossField& field_;
  std::span<const Vec3> centres_;
  std::span<const double> sizes_;
  std::vector<Link> links_;
};

void Linker::make_links() {
  for (HalfEdge h = 0; h < static_cast<HalfEdge>(links_.size()); ++h) {
    const HalfEdge twin = surface_.twins[h];
    if (surface_.feature[h] || twin < h) continue;
    links_[h] = make_link(h);
    links_[twin] = reversed(links_[h], triangle_of(h));
  }
}

// Of the triangle of h, to that beyond it, as both lie unfolded.
Link Linker::make_link(HalfEdge h) const {
  const HalfEdge twin = surface_.twins[h];
  const std::int32_t f = triangle_of(h), g = triangle_of(twin);
  const auto here = directions(f), there = directions(g);
  const Vec3 side = surface_.edge_vector(h);
  const Vec3 along = unit(side), &inward = surface_.inward(h), &beyond = surface_.inward(twin);
  const Vec3 middle = surface_.points[start_of(surface_.triangles, h)] + 0.5 * side;
  Link link;
  link.neighbour = g;
  double quality = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 unfolded = dot(here[k], along) * along - dot(here[k], inward) * beyond;
    const std::array<double, 2> cosines{dot(unfolded, there[0]), dot(unfolded, there[1])};
    if (k == 0) link.crossed = std::abs(cosines[1]) > std::abs(cosines[0]);
    const std::size_t axis = link.crossed ? 1 - k : k;
    link.flipped[k] = cosines[axis] < 0;
    quality += std::abs(cosines[axis]) / 2;
    const Vec3 matched = link.flipped[k] ? -there[axis] : there[axis];
    const double distance = dot(here[k], centres_[f] - middle) + dot(matched, middle - centres_[g]);
    link.distance[k] = distance / (0.5 * (sizes_[f] + sizes_[g]));
  }
  turn(link);
  const double across = dot(centres_[f] - middle, inward) + dot(centres_[g] - middle, beyond);
  link.weight = norm(side) / std::max(across, 1e-3 * norm(side)) * std::max(0.0, 4 * quality - 3);
  return link;
}

void Linker::turn(Link& link) {
  for (std::size_t k = 0; k < 2; ++k) link.turn[k] = std::polar(1.0, 2 * std::numbers::pi * link.distance[k]);
}

Link Linker::reversed(const Link& link, std::int32_t from) {
  Link back;
  back.neighbour = from;
  back.weight = link.weight;
  back.crossed = link.crossed;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t there = link.crossed ? 1 - k : k;
    back.flipped[there] = link.flipped[k];
    back.distance[there] = link.flipped[k] ? link.distance[k] : -link.distance[k];
  }
  turn(back);
  return back;
}

// Distances that add up around vertices, as far as directions do.
void Linker::correct_curl() {
  std::vector<float> distances(2 * links_.size());
  for_each_pair([&](HalfEdge h) {
    for (std::size_t k = 0; k < 2; ++k) distances[number_of(h, k)] = static_cast<float>(links_[h].distance[k]);
  });
  Loops loops;
  std::vector<bool> seen(surface_.points.size());
  for (HalfEdge h = 0; h < static_cast<HalfEdge>(links_.size()); ++h) {
    const Vertex v = start_of(surface_.triangles, h);
    if (seen[v]) continue;
    seen[v] = true;
    add_loops(h, loops);
  }
  const std::vector<float> correction = curl_correction(distances, loops);
  for_each_pair([&](HalfEdge h) {
    Link& link = links_[h];
    const std::int32_t f = triangle_of(h);
    const double longest = most_strain * norm(centres_[f] - centres_[link.neighbour]) / sizes_[f];
    for (std::size_t k = 0; k < 2; ++k)
      link.distance[k] += std::clamp<double>(correction[number_of(h, k)], -longest, longest);
    turn(link);
    links_[surface_.twins[h]] = reversed(link, f);
  });
}

// Around the start of a half-edge, along both directions of its triangle, unless a feature is in the way or they are
// not the same at the end.
void Linker::add_loops(HalfEdge first, Loops& loops) const {
  for (std::size_t k = 0; k < 2; ++k) {
    std::size_t axis = k;
    bool flipped = false;
    HalfEdge h = first;
    do {
      const Link& link = links_[h];
      if (link.neighbour < 0 || link.weight <= 0) return loops.drop();
      const HalfEdge twin = surface_.twins[h];
      const std::size_t there = link.crossed ? 1 - axis : axis;
      const bool turned = flipped != link.flipped[axis];
      if (h < twin)
        loops.add_step(number_of(h, axis), flipped);
      else
        loops.add_step(number_of(twin, there), !turned);
      axis = there;
      flipped = turned;
      h = next_in_triangle(twin);
    } while (h != first);
    if (axis != k || flipped) return loops.drop();
    loops.close();
  }
}

}  // namespace

std::vector<SurfaceLink> surface_links(const FieldSurface& surface, const CrossField& field,
                                       std::span<const Vec3> centres, std::span<const double> sizes) {
  return Linker(surface, field, centres, sizes).run();
}

}  // namespace hexpipe
