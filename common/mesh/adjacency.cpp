#include "common/mesh/adjacency.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "common/mesh/cell_topology.hpp"
#include "common/run/error.hpp"
#include "common/run/memory.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe {
namespace {

// A facet, filed under its lowest vertex. `others` holds its middle vertex in the high bits and its highest in the low
// bits; `code` is 4 * tet + facet.
struct FiledFacet {
  std::uint64_t others;
  std::int64_t code;
};

// The corners of a tet, sorted by vertex.
std::array<int, 4> ascending_corners(const Tet& tet) {
  std::array<std::int64_t, 4> keys;
  for (int corner = 0; corner < 4; ++corner) keys[corner] = std::int64_t{tet[corner]} * 4 + corner;
  const auto order = [&](int i, int j) {
    const std::int64_t lesser = std::min(keys[i], keys[j]);
    keys[j] = std::max(keys[i], keys[j]);
    keys[i] = lesser;
  };
  order(0, 1);
  order(2, 3);
  order(0, 2);
  order(1, 3);
  order(1, 2);
  return {static_cast<int>(keys[0] & 3), static_cast<int>(keys[1] & 3), static_cast<int>(keys[2] & 3),
          static_cast<int>(keys[3] & 3)};
}

// Calls visit(lowest, middle, highest, facet) for the three facets of a tet that contain its lowest vertex.
template <class Visit>
void for_each_sorted_facet(const Tet& tet, Visit&& visit) {
  const auto c = ascending_corners(tet);
  visit(tet[c[0]], tet[c[1]], tet[c[2]], c[3]);
  visit(tet[c[0]], tet[c[1]], tet[c[3]], c[2]);
  visit(tet[c[0]], tet[c[2]], tet[c[3]], c[1]);
  visit(tet[c[1]], tet[c[2]], tet[c[3]], c[0]);
}

// Turns counts into offsets: entry v becomes the sum of the counts before v, the last entry the total.
std::vector<std::int64_t> offsets_from_counts(std::vector<std::int64_t> counts) {
  counts.push_back(0);
  std::exclusive_scan(counts.begin(), counts.end(), counts.begin(), std::int64_t{0});
  return counts;
}

std::vector<TetIndex> match_facets(const TetMesh& mesh, const char* source, std::span<const TetIndex> numbers) {
  std::vector<std::int64_t> counts(mesh.points.size(), 0);
  for (const Tet& tet : mesh.tets)
    for_each_sorted_facet(tet, [&](Vertex lowest, Vertex, Vertex, int) { ++counts[lowest]; });
  const std::vector<std::int64_t> offsets = offsets_from_counts(std::move(counts));

  std::vector<FiledFacet> filed;
  resize_in_huge_pages(filed, 4 * mesh.tets.size());
  std::vector<std::int64_t> next(offsets.begin(), offsets.end() - 1);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for_each_sorted_facet(mesh.tets[t], [&](Vertex lowest, Vertex middle, Vertex highest, int facet) {
      filed[next[lowest]++] = {static_cast<std::uint64_t>(middle) << 32 | static_cast<std::uint32_t>(highest),
                               static_cast<std::int64_t>(4 * t) + facet};
    });

  const auto throw_too_many_tets = [&](std::array<std::int64_t, 3> tets, std::int64_t lowest, std::uint64_t others) {
    if (!numbers.empty())
      for (std::int64_t& tet : tets) tet = numbers[tet];
    std::sort(tets.begin(), tets.end());
    throw DataError::at(
        source, "expected at most two tets at each facet, found tets {}, {} and {} at vertices {} {} {}", tets[0] + 1,
        tets[1] + 1, tets[2] + 1, lowest + 1, (others >> 32) + 1, (others & 0xffffffff) + 1);
  };
  std::vector<TetIndex> across;
  resize_in_huge_pages(across, 4 * mesh.tets.size());
  parallel_for(static_cast<std::int64_t>(mesh.points.size()), 1024, [&](std::int64_t v) {
    const auto begin = filed.begin() + offsets[v], end = filed.begin() + offsets[v + 1];
    std::sort(begin, end, [](const FiledFacet& a, const FiledFacet& b) {
      return a.others < b.others || (a.others == b.others && a.code < b.code);
    });
    auto same = [](const FiledFacet& a, const FiledFacet& b) { return a.others == b.others; };
    for (auto i = begin; i != end && i + 1 != end; ++i) {
      if (!same(*i, *(i + 1))) continue;
      if (i + 2 != end && same(*i, *(i + 2)))
        throw_too_many_tets({i->code / 4, (i + 1)->code / 4, (i + 2)->code / 4}, v, i->others);
      across[i->code] = TetIndex((i + 1)->code / 4);
      across[(i + 1)->code] = TetIndex(i->code / 4);
      ++i;
    }
  });
  return across;
}

}  // namespace

TetAdjacency::TetAdjacency(const TetMesh& mesh, const char* source, std::span<const TetIndex> numbers) {
  both_at_once([&] { across_ = match_facets(mesh, source, numbers); },
               [&] {
                 file_tets(mesh);
                 find_neighbours(mesh);
               });
}

void TetAdjacency::file_tets(const TetMesh& mesh) {
  std::vector<std::int64_t> counts(mesh.points.size(), 0);
  for (const Tet& tet : mesh.tets)
    for (const Vertex v : tet) ++counts[v];
  tet_offsets_ = offsets_from_counts(std::move(counts));

  resize_in_huge_pages(tets_at_vertex_, 4 * mesh.tets.size());
  std::vector<std::int64_t> next(tet_offsets_.begin(), tet_offsets_.end() - 1);
  for (const auto t : indices<TetIndex>(mesh.tets.size()))
    for (const Vertex v : mesh.tets[t]) tets_at_vertex_[next[v]++] = t;
}

void TetAdjacency::find_neighbours(const TetMesh& mesh) {
  const std::size_t vertex_count = mesh.points.size();
  neighbour_offsets_.assign(vertex_count + 1, 0);
  // By Euler's formula there are about as many edges as vertices and tets together, and each is listed at both ends.
  // The boundary adds little.
  reserve_in_huge_pages(neighbours_, 2 * (vertex_count + mesh.tets.size()));
  PerThread<std::vector<Vertex>> seen_from(
      std::vector<Vertex>(vertex_count, no_index));  // by vertex: the last vertex that saw it
  parallel_in_order(
      static_cast<std::int64_t>(vertex_count), 1024,
      [&](std::int64_t begin, std::int64_t end) {
        std::pair<std::vector<std::int64_t>, std::vector<Vertex>> block;
        std::vector<Vertex>& last_seen_from = seen_from.local();
        for (std::int64_t v = begin; v < end; ++v) {
          const auto before = static_cast<std::ptrdiff_t>(block.second.size());
          last_seen_from[v] = static_cast<Vertex>(v);
          for (const TetIndex t : tets_at(static_cast<Vertex>(v)))
            for (const Vertex w : mesh.tets[t])
              if (std::exchange(last_seen_from[w], static_cast<Vertex>(v)) != v) block.second.push_back(w);
          std::sort(block.second.begin() + before, block.second.end());
          block.first.push_back(static_cast<std::int64_t>(block.second.size()) - before);
        }
        return block;
      },
      [&, v = std::size_t{0}](auto&& block) mutable {
        for (const std::int64_t count : block.first) {
          neighbour_offsets_[v + 1] = neighbour_offsets_[v] + count;
          ++v;
        }
        neighbours_.insert(neighbours_.end(), block.second.begin(), block.second.end());
      });
}

bool TetAdjacency::has_edge(Vertex a, Vertex b) const {
  const auto around = neighbours_of(a);
  return std::binary_search(around.begin(), around.end(), b);
}

std::size_t add_missing_boundary_triangles(TetMesh& mesh, const TetAdjacency& adjacency, std::int32_t tag) {
  auto key = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  std::vector<Triangle> named(mesh.triangles.size());
  std::transform(mesh.triangles.begin(), mesh.triangles.end(), named.begin(), key);
  std::sort(named.begin(), named.end());

  const std::size_t before = mesh.triangles.size();
  for (const auto t : indices<TetIndex>(mesh.tets.size()))
    for (int facet = 0; facet < 4; ++facet) {
      const TetIndex beyond = adjacency.tet_beyond(t, facet);
      const bool boundary = beyond == no_index;
      const bool interface = !boundary && beyond > t && mesh.tet_tags[beyond] != mesh.tet_tags[t];
      if (!boundary && !interface) continue;
      const auto& corners = TetTopology::triangles[facet];
      const Tet& tet = mesh.tets[t];
      const Triangle triangle{tet[corners[0]], tet[corners[1]], tet[corners[2]]};
      if (std::binary_search(named.begin(), named.end(), key(triangle))) continue;
      mesh.triangles.push_back(triangle);
    }
  mesh.triangle_tags.resize(mesh.triangles.size(), tag);
  return mesh.triangles.size() - before;
}

}  // namespace hexpipe
