#include "tools/assemble/hybrid/hybrid_mesh.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace hexpipe::assemble::hybrid {

Quad HybridCell::quad(int i) const {
  return with_topology(kind, [&](auto topology) {
    Quad result{};
    if constexpr (!decltype(topology)::quads.empty())
      for (int k = 0; k < 4; ++k) result[k] = corners[decltype(topology)::quads[i][k]];
    return result;
  });
}

std::span<const VertexKey<4>> HybridCell::quad_keys(std::array<VertexKey<4>, 6>& keys) const {
  const auto count = static_cast<std::size_t>(quad_count());
  for (std::size_t i = 0; i < count; ++i) keys[i] = key_of(quad(static_cast<int>(i)));
  return std::span(keys).first(count);
}

HybridMesh::HybridMesh(const TetMesh& mesh, const std::vector<bool>& removed)
    : HybridMesh(mesh, removed, {}, CellQuads(mesh.points.size())) {}

HybridMesh::HybridMesh(const TetMesh& mesh, const std::vector<bool>& removed,
                       IndexedVector<CellIndex, HybridCell> cells, CellQuads quads)
    : points(mesh.points),
      tets_(mesh.tets),
      regions_(mesh.tet_tags),
      alive_(mesh.tets.size(), 0),
      first_(mesh.points.size(), no_index),
      next_(4 * mesh.tets.size(), no_index),
      tet_counts_(mesh.points.size(), 0),
      cells_(std::move(cells)),
      quads_(std::move(quads)) {
  assert(removed.size() == tets_.size());
  for (std::size_t t = tets_.size(); t-- > 0;)
    if (!removed[t]) link(TetIndex(t));
}

Vertex HybridMesh::add_point(const Vec3& at) {
  points.push_back(at);
  first_.push_back(no_index);
  tet_counts_.push_back(0);
  quads_.add_vertex();
  return static_cast<Vertex>(points.size() - 1);
}

void HybridMesh::link(TetIndex t) {
  assert(!alive_[t]);
  alive_[t] = 1;
  for (int i = 0; i < 4; ++i) {
    const std::int64_t slot = 4 * static_cast<std::int64_t>(t) + i;
    next_[slot] = first_[tets_[t][i]];
    first_[tets_[t][i]] = slot;
    ++tet_counts_[tets_[t][i]];
  }
}

void HybridMesh::unlink(TetIndex t) {
  assert(alive_[t]);
  alive_[t] = 0;
  for (int i = 0; i < 4; ++i) {
    const std::int64_t slot = 4 * static_cast<std::int64_t>(t) + i;
    std::int64_t* at = &first_[tets_[t][i]];
    while (*at != slot) at = &next_[*at];
    *at = next_[slot];
    --tet_counts_[tets_[t][i]];
  }
}

TetIndex HybridMesh::add_tet(const Tet& tet, std::int32_t region) {
  const TetIndex t(tets_.size());
  tets_.push_back(tet);
  regions_.push_back(region);
  alive_.push_back(0);
  next_.resize(next_.size() + 4, no_index);
  link(t);
  return t;
}

void HybridMesh::remove_tet(TetIndex t) {
  unlink(t);
}
void HybridMesh::restore_tet(TetIndex t) {
  link(t);
}

namespace {

bool has_vertex(const Tet& tet, Vertex v) {
  return tet[0] == v || tet[1] == v || tet[2] == v || tet[3] == v;
}

}  // namespace

// Where faces of CAD come as fans, a corner has a thousand tets and its neighbours have ten. Whichever is asked, the
// tets come in the same order, that in which they were linked.
Vertex HybridMesh::with_fewest_tets(std::span<const Vertex> vertices) const {
  return *std::ranges::min_element(vertices, {}, [&](Vertex v) { return tet_counts_[v]; });
}

TetIndex HybridMesh::tet_at(const Triangle& triangle, TetIndex except) const {
  TetIndex found = no_index;
  for_tets_at(with_fewest_tets(triangle), [&](TetIndex t) {
    const Tet& tet = tets_[t];
    if (t != except && std::ranges::all_of(triangle, [&](Vertex v) { return has_vertex(tet, v); })) found = t;
  });
  return found;
}

void HybridMesh::tets_around_edge(Vertex a, Vertex b, std::vector<TetIndex>& out) const {
  out.clear();
  for_tets_at(with_fewest_tets(std::array{a, b}), [&](TetIndex t) {
    if (has_vertex(tets_[t], a) && has_vertex(tets_[t], b)) out.push_back(t);
  });
}

CellIndex HybridMesh::add_cell(const HybridCell& cell) {
  const CellIndex c(cells_.size());
  cells_.push_back(cell);
  std::array<VertexKey<4>, 6> keys;
  quads_.add(c, cell.quad_keys(keys));
  return c;
}

void HybridMesh::remove_cell(CellIndex c) {
  assert(cells_[c].alive);
  cells_[c].alive = false;
  quads_.remove(c, cells_[c].quad_count());
}

}  // namespace hexpipe::assemble::hybrid
