#include "tools/findhex/quad_table.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/run/parallel.hpp"

namespace hexpipe {
namespace {

constexpr std::int64_t vertices_a_block = 1024;

using VertexQuad = std::array<Vertex, 4>;  // in cyclic order

// The test is a filter before that of the corners, so its rounding must not reject what that one accepts.
constexpr double filter_slack = 1 - 1e-9;

class QuadFinder {
 public:
  QuadFinder(const TetMesh& mesh, const TetAdjacency& adjacency, const FacetTable& facets, const QuadFilter& filter)
      : mesh_(mesh), adjacency_(adjacency), facets_(facets), filter_(filter) {}

  // Appends the quads that have a diagonal from v to a greater vertex and are not found from their other diagonal.
  void find(Vertex v, std::vector<VertexQuad>& found) {
    collect_rings(v);
    for (auto ring = ring_.begin(); ring != ring_.end();) {
      const auto end = std::find_if(ring, ring_.end(), [&](const auto& at) { return at.first != ring->first; });
      for (auto b = ring; b != end; ++b)
        for (auto d = b + 1; d != end; ++d) {
          const VertexQuad quad{v, b->second, ring->first, d->second};
          if (is_wanted(quad)) found.push_back(quad);
        }
      ring = end;
    }
  }

 private:
  // The facets at edges from v to a greater vertex, as (that vertex, third vertex), ascending.
  void collect_rings(Vertex v) {
    ring_.clear();
    for (const std::int32_t t : adjacency_.tets_at(v))
      for (const Vertex end : mesh_.tets[t])
        if (end > v)
          for (const Vertex third : mesh_.tets[t])
            if (third != v && third != end) ring_.emplace_back(end, third);
    std::sort(ring_.begin(), ring_.end());
    ring_.erase(std::unique(ring_.begin(), ring_.end()), ring_.end());
    std::erase_if(ring_, [&](const auto& at) { return !facets_.has(v, at.first, at.second); });
  }

  // quad[0] quad[2] is the diagonal whose triangles are facets.
  bool is_wanted(const VertexQuad& quad) const {
    const std::array<Vec3, 4> p{mesh_.points[quad[0]], mesh_.points[quad[1]], mesh_.points[quad[2]],
                                mesh_.points[quad[3]]};
    if (!angles_suffice(p)) return false;
    if (filter_.drop_folded && is_folded(p[0], p[1], p[2], p[3])) return false;
    const bool other_is_first = std::pair(quad[1], quad[3]) < std::pair(quad[0], quad[2]);
    return !(other_is_first && has_other_diagonal(quad, p));
  }

  bool has_other_diagonal(const VertexQuad& q, const std::array<Vec3, 4>& p) const {
    return facets_.has(q[0], q[1], q[3]) && facets_.has(q[1], q[2], q[3]) &&
           !(filter_.drop_folded && is_folded(p[1], p[2], p[3], p[0]));
  }

  bool angles_suffice(const std::array<Vec3, 4>& p) const {
    const double least = filter_.min_quality * filter_.min_quality * filter_slack;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 u = p[(i + 1) % 4] - p[i], v = p[(i + 3) % 4] - p[i];
      if (norm_squared(cross(u, v)) < least * norm_squared(u) * norm_squared(v)) return false;
    }
    return true;
  }

  const TetMesh& mesh_;
  const TetAdjacency& adjacency_;
  const FacetTable& facets_;
  const QuadFilter filter_;
  std::vector<std::pair<Vertex, Vertex>> ring_;
};

}  // namespace

QuadTable::QuadTable(const TetMesh& mesh, const TetAdjacency& adjacency, const FacetTable& facets,
                     const QuadFilter& filter) {
  std::vector<VertexQuad> quads;
  parallel_in_order(
      static_cast<std::int64_t>(mesh.points.size()), vertices_a_block,
      [&](std::int64_t begin, std::int64_t end) {
        std::vector<VertexQuad> found;
        QuadFinder finder(mesh, adjacency, facets, filter);
        for (std::int64_t v = begin; v < end; ++v) finder.find(static_cast<Vertex>(v), found);
        return found;
      },
      [&](std::vector<VertexQuad>&& found) { quads.insert(quads.end(), found.begin(), found.end()); });
  file(quads, mesh.points.size());
}

QuadTable::Key QuadTable::key(Vertex side, Vertex other_side) {
  const auto [low, high] = std::minmax(side, other_side);
  return static_cast<Key>(low) << 32 | static_cast<Key>(high);
}

void QuadTable::file(const std::vector<VertexQuad>& quads, std::size_t vertex_count) {
  offsets_.assign(vertex_count + 1, 0);
  for (const VertexQuad& quad : quads)
    for (const Vertex v : quad) ++offsets_[v + 1];
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());

  struct Entry {
    Key sides;
    Vertex opposite;
  };
  std::vector<Entry> entries(4 * quads.size());
  std::vector<std::int64_t> next(offsets_.begin(), offsets_.end() - 1);
  for (const VertexQuad& quad : quads)
    for (std::size_t i = 0; i < 4; ++i)
      entries[next[quad[i]]++] = {key(quad[(i + 1) % 4], quad[(i + 3) % 4]), quad[(i + 2) % 4]};

  sides_.resize(entries.size());
  opposite_.resize(entries.size());
  parallel_for(static_cast<std::int64_t>(vertex_count), vertices_a_block, [&](std::int64_t v) {
    std::sort(entries.begin() + offsets_[v], entries.begin() + offsets_[v + 1], [](const Entry& a, const Entry& b) {
      return std::pair(a.sides, a.opposite) < std::pair(b.sides, b.opposite);
    });
    for (std::int64_t i = offsets_[v]; i < offsets_[v + 1]; ++i) {
      sides_[i] = entries[i].sides;
      opposite_[i] = entries[i].opposite;
    }
  });
}

std::span<const Vertex> QuadTable::opposites(Vertex corner, Vertex side, Vertex other_side) const {
  const Key wanted = key(side, other_side);
  const auto end = sides_.begin() + offsets_[corner + 1];
  const auto first = std::lower_bound(sides_.begin() + offsets_[corner], end, wanted);
  auto last = first;
  while (last != end && *last == wanted) ++last;
  return std::span(opposite_).subspan(first - sides_.begin(), last - first);
}

}  // namespace hexpipe
