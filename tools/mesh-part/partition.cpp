// Parts of equal size with few facets between them: multilevel k-way partitioning of the dual graph, whose vertices are
// the tets and whose edges are the facets that two tets share. G. Karypis and V. Kumar, Multilevel k-way partitioning
// scheme for irregular graphs (J. Parallel Distrib. Comput. 48, 1998), by their METIS; it may leave a part empty, which
// gets a tet of the largest one here.

#include "tools/mesh-part/mesh_cutter.hpp"

#include <metis.h>

#include <algorithm>
#include <array>
#include <limits>

#include "common/run/error.hpp"

namespace hexpipe::mesh_part {
namespace {

static_assert(sizeof(idx_t) >= sizeof(std::int32_t));

struct DualGraph {
  std::vector<idx_t> offsets{0}, neighbours;
};

DualGraph dual_graph(const TetAdjacency& adjacency, std::int64_t tet_count) {
  DualGraph graph;
  graph.offsets.reserve(tet_count + 1);
  graph.neighbours.reserve(4 * tet_count);
  for (std::int64_t t = 0; t < tet_count; ++t) {
    for (const TetIndex beyond : adjacency.tets_beyond(TetIndex(t)))
      if (beyond != no_index) graph.neighbours.push_back(beyond);
    graph.offsets.push_back(static_cast<idx_t>(graph.neighbours.size()));
  }
  return graph;
}

std::vector<idx_t> by_metis(DualGraph graph, std::int32_t part_count, std::uint64_t seed, const char* source) {
  auto vertices = static_cast<idx_t>(graph.offsets.size() - 1);
  idx_t constraints = 1, parts = part_count, cut = 0;
  std::vector<idx_t> part(vertices);
  std::array<idx_t, METIS_NOPTIONS> options{};
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = static_cast<idx_t>(seed & 0x7fffffff);
  const int status =
      METIS_PartGraphKway(&vertices, &constraints, graph.offsets.data(), graph.neighbours.data(), nullptr, nullptr,
                          nullptr, &parts, nullptr, nullptr, options.data(), &cut, part.data());
  if (status == METIS_ERROR_MEMORY) throw std::bad_alloc();
  if (status != METIS_OK) throw DataError::at(source, "METIS cannot split these tets: error {}", status);
  return part;
}

// Gives each empty part the last tet of the largest.
void fill_empty_parts(std::vector<std::int32_t>& tet_part, std::int32_t parts) {
  std::vector<std::int64_t> sizes(parts, 0);
  for (const std::int32_t part : tet_part) ++sizes[part];
  for (std::int32_t empty = 0; empty < parts; ++empty) {
    if (sizes[empty] > 0) continue;
    const auto largest = static_cast<std::int32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    *std::find(tet_part.rbegin(), tet_part.rend(), largest) = empty;
    --sizes[largest];
    ++sizes[empty];
  }
}

std::int32_t most_frequent(std::vector<std::int32_t>& parts) {
  std::sort(parts.begin(), parts.end());
  std::int32_t best = 0;
  std::ptrdiff_t most = 0;
  for (auto begin = parts.begin(); begin != parts.end();) {
    const auto end = std::upper_bound(begin, parts.end(), *begin);
    if (end - begin > most) {
      most = end - begin;
      best = *begin;
    }
    begin = end;
  }
  return best;
}

std::vector<std::int32_t> owners_of_points(std::size_t point_count, const TetAdjacency& adjacency,
                                           const std::vector<std::int32_t>& tet_part) {
  std::vector<std::int32_t> owners(point_count), around;
  for (std::size_t v = 0; v < point_count; ++v) {
    around.clear();
    for (const TetIndex t : adjacency.tets_at(static_cast<Vertex>(v))) around.push_back(tet_part[t]);
    owners[v] = most_frequent(around);
  }
  return owners;
}

}  // namespace

Partition partition(const TetMesh& mesh, const TetAdjacency& adjacency, std::int32_t parts, std::uint64_t seed,
                    const char* source) {
  const auto tet_count = static_cast<std::int64_t>(mesh.tets.size());
  if (tet_count < parts)
    throw DataError::at(source, "expected at least one tet for each of the {} parts, found {}", parts, tet_count);
  if (tet_count > std::numeric_limits<idx_t>::max() / 4)
    throw DataError::at(source, "expected at most {} tets, which METIS can count, found {}",
                        std::numeric_limits<idx_t>::max() / 4, tet_count);
  Partition result;
  result.tet_part.assign(mesh.tets.size(), 0);
  if (parts > 1) {
    const std::vector<idx_t> part = by_metis(dual_graph(adjacency, tet_count), parts, seed, source);
    std::copy(part.begin(), part.end(), result.tet_part.begin());
    fill_empty_parts(result.tet_part, parts);
  }
  result.point_part = owners_of_points(mesh.points.size(), adjacency, result.tet_part);
  return result;
}

}  // namespace hexpipe::mesh_part
