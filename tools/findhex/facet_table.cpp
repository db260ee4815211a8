#include "tools/findhex/facet_table.hpp"

#include <algorithm>
#include <tuple>

#include "common/mesh/cell_topology.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe {
namespace {

constexpr std::int64_t vertices_a_block = 1024;

struct Sorted {
  Vertex low, middle, high;
  bool even;  // the permutation that sorted them
};

Sorted sorted(Vertex a, Vertex b, Vertex c) {
  bool even = true;
  auto order = [&even](Vertex& x, Vertex& y) {
    if (x <= y) return;
    std::swap(x, y);
    even = !even;
  };
  order(a, b);
  order(b, c);
  order(a, b);
  return {a, b, c, even};
}

bool less(const FacetTable::Facet& a, const FacetTable::Facet& b) {
  return std::tie(a.middle, a.high) < std::tie(b.middle, b.high);
}

// The facets whose lowest vertex is v, ascending, each once.
void collect_facets(const TetMesh& mesh, const TetAdjacency& adjacency, const std::vector<bool>& usable, Vertex v,
                    std::vector<FacetTable::Facet>& found) {
  const auto begin = static_cast<std::ptrdiff_t>(found.size());
  for (const std::int32_t t : adjacency.tets_at(v)) {
    if (!usable[t]) continue;
    const Tet& tet = mesh.tets[t];
    for (const LocalTriangle& corners : TetTopology::triangles) {
      const Sorted facet = sorted(tet[corners[0]], tet[corners[1]], tet[corners[2]]);
      if (facet.low != v) continue;
      found.push_back({facet.middle, facet.high, {FacetTable::none, FacetTable::none}});
      found.back().tets[facet.even ? 0 : 1] = t;
    }
  }
  std::sort(found.begin() + begin, found.end(), less);
  auto last = found.begin() + begin;
  for (auto next = last; next != found.end(); ++next) {
    if (next == last) continue;
    if (less(*last, *next)) {
      *++last = *next;
      continue;
    }
    for (int side = 0; side < 2; ++side) last->tets[side] = std::max(last->tets[side], next->tets[side]);
  }
  if (last != found.end()) found.erase(last + 1, found.end());
}

}  // namespace

FacetTable::FacetTable(const TetMesh& mesh, const TetAdjacency& adjacency, const std::vector<bool>& usable)
    : offsets_{0} {
  struct Block {
    std::vector<std::int64_t> ends;
    std::vector<Facet> facets;
  };
  offsets_.reserve(mesh.points.size() + 1);
  facets_.reserve(2 * mesh.tets.size());
  parallel_in_order(
      static_cast<std::int64_t>(mesh.points.size()), vertices_a_block,
      [&](std::int64_t begin, std::int64_t end) {
        Block block;
        for (std::int64_t v = begin; v < end; ++v) {
          collect_facets(mesh, adjacency, usable, static_cast<Vertex>(v), block.facets);
          block.ends.push_back(static_cast<std::int64_t>(block.facets.size()));
        }
        return block;
      },
      [&](Block&& block) {
        const auto base = static_cast<std::int64_t>(facets_.size());
        for (const std::int64_t end : block.ends) offsets_.push_back(base + end);
        facets_.insert(facets_.end(), block.facets.begin(), block.facets.end());
      });
}

const FacetTable::Facet* FacetTable::find(Vertex a, Vertex b, Vertex c) const {
  const Sorted wanted = sorted(a, b, c);
  const Facet key{wanted.middle, wanted.high, {none, none}};
  const Facet* const end = facets_.data() + offsets_[wanted.low + 1];
  const Facet* const at = std::lower_bound(facets_.data() + offsets_[wanted.low], end, key, less);
  return at != end && !less(key, *at) ? at : nullptr;
}

std::int32_t FacetTable::tet_inside(Vertex a, Vertex b, Vertex c) const {
  const Facet* const facet = find(a, b, c);
  return facet ? facet->tets[sorted(a, b, c).even ? 0 : 1] : none;
}

}  // namespace hexpipe
