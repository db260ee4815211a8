#include "tools/assemble/choice/selection.hpp"

#include <fmt/format.h>

#include <optional>

#include "common/run/error.hpp"

namespace hexpipe::assemble::choice {
namespace {

// Interior tets by the cell that replaces them, slivers by how many cells absorb them.
struct Claims {
  std::vector<std::int32_t> owner;  // candidate, or HybridCell::none
  std::vector<std::uint8_t> absorbed;
};

[[noreturn]] void fail_conflict(const InputNames& names, std::int32_t a, std::int32_t b, const char* how) {
  throw DataError::at(names.solution, "expected candidates that fit together, found {} and {} which {}",
                      title_of(names, a), title_of(names, b), how);
}

void claim_interior(const InputNames& names, const Candidates& candidates, std::int32_t candidate, Claims& claims) {
  for (std::int32_t t : candidates.interior_tets_of(candidate)) {
    if (claims.owner[t] != hybrid::HybridCell::none) fail_conflict(names, claims.owner[t], candidate, "share a tet");
    claims.owner[t] = candidate;
  }
}

// The facets of the interior tets that no two of them share: the skin of what the cell replaces. At most 15 tets, so
// quadratic search is the fast one.
std::vector<VertexKey<3>> skin_of(const TetMesh& mesh, std::span<const std::int32_t> tets) {
  std::vector<VertexKey<3>> skin;
  for (std::int32_t t : tets)
    for (const auto& f : TetTopology::triangles) {
      const auto key = key_of(Triangle{mesh.tets[t][f[0]], mesh.tets[t][f[1]], mesh.tets[t][f[2]]});
      const auto twin = std::find(skin.begin(), skin.end(), key);
      if (twin == skin.end()) {
        skin.push_back(key);
      } else {
        *twin = skin.back();
        skin.pop_back();
      }
    }
  return skin;
}

bool contains_all(const std::vector<VertexKey<3>>& skin, std::span<const Triangle> triangles) {
  return std::all_of(triangles.begin(), triangles.end(),
                     [&](const Triangle& t) { return std::find(skin.begin(), skin.end(), key_of(t)) != skin.end(); });
}

// Finds each facet of the cell on the skin, and each quad's diagonal; nullopt when the skin is not the cell's.
template <class Topology>
bool match_skin(const std::vector<VertexKey<3>>& skin, hybrid::HybridCell& cell) {
  if (skin.size() != Topology::triangles.size() + 2 * Topology::quads.size()) return false;
  for (const auto& f : Topology::triangles) {
    const Triangle triangle{cell.corners[f[0]], cell.corners[f[1]], cell.corners[f[2]]};
    if (!contains_all(skin, std::span(&triangle, 1))) return false;
  }
  for (int i = 0; i < static_cast<int>(Topology::quads.size()); ++i) {
    const bool first = contains_all(skin, triangles_of(cell.quad(i), 0));
    if (!first && !contains_all(skin, triangles_of(cell.quad(i), 1))) return false;
    cell.inner_diagonal[i] = first ? 0 : 1;
  }
  return true;
}

int quad_with_vertices(const hybrid::HybridCell& cell, const VertexKey<4>& key) {
  for (int i = 0; i < cell.quad_count(); ++i)
    if (key_of(cell.quad(i)) == key) return i;
  return -1;
}

// Nothing where the tets do not form it.
std::optional<hybrid::HybridCell> cell_of(const TetMesh& mesh, const Candidates& candidates, std::int32_t candidate) {
  const auto interior = candidates.interior_tets_of(candidate);
  if (interior.empty() || candidates.kind[candidate] == CellKind::tet) return std::nullopt;
  hybrid::HybridCell cell;
  cell.kind = candidates.kind[candidate];
  cell.corners = candidates.vertices[candidate];
  cell.candidate = candidate;
  cell.region = mesh.tet_tags[interior.front()];
  for (std::int32_t t : interior)
    if (mesh.tet_tags[t] != cell.region) return std::nullopt;
  const auto skin = skin_of(mesh, interior);
  if (!with_topology(cell.kind, [&](auto topology) { return match_skin<decltype(topology)>(skin, cell); }))
    return std::nullopt;
  for (std::int32_t t : candidates.boundary_tets_of(candidate)) {
    const int quad = quad_with_vertices(cell, key_of(mesh.tets[t]));
    if (quad < 0 || cell.sliver[quad] != hybrid::HybridCell::none || mesh.tet_tags[t] != cell.region)
      return std::nullopt;
    cell.sliver[quad] = t;
  }
  return cell;
}

// Which chosen cell has a quad, to notice a third and one in another cyclic order.
struct QuadOwner {
  std::int32_t cell;
  Quad quad;
  std::int32_t partner = hybrid::HybridCell::none;
};

void pair_quads(const InputNames& names, const std::vector<hybrid::HybridCell>& cells, KeyMap<4, QuadOwner>& owners) {
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(cells.size()); ++c)
    for (int i = 0; i < cells[c].quad_count(); ++i) {
      const Quad quad = cells[c].quad(i);
      auto [entry, added] = owners.try_emplace(key_of(quad), QuadOwner{c, quad});
      if (added) continue;
      QuadOwner& owner = entry.value();
      if (owner.partner != hybrid::HybridCell::none || !same_diagonals(owner.quad, quad))
        fail_conflict(names, cells[owner.cell].candidate, cells[c].candidate, "cross at a quad");
      owner.partner = c;
    }
}

void absorb_slivers(const InputNames& names, const hybrid::SurfaceTags& tags, const KeyMap<4, QuadOwner>& owners,
                    std::vector<hybrid::HybridCell>& cells, Claims& claims) {
  for (auto& cell : cells)
    for (int i = 0; i < cell.quad_count(); ++i) {
      std::int32_t& sliver = cell.sliver[i];
      if (sliver == hybrid::HybridCell::none) continue;
      if (claims.owner[sliver] != hybrid::HybridCell::none)
        fail_conflict(names, claims.owner[sliver], cell.candidate, "share a tet");
      const bool alone = owners.at(key_of(cell.quad(i))).partner == hybrid::HybridCell::none;
      if (alone && tags.covers_partly(cell.quad(i), cell.outer_diagonal(i)))
        sliver = hybrid::HybridCell::none;
      else
        claims.absorbed[sliver] = 1;
    }
}

// Each half of a quad without a partner has to face a tet or lie on the boundary; else another cell stands across it.
// Likewise no other cell may use its diagonal, which conformity is going to split.
void check_open_sides(const InputNames& names, const hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags) {
  KeyMap<2, std::int32_t> diagonals;
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(mesh.cell_count()); ++c)
    for (int i = 0; i < mesh.cell(c).quad_count(); ++i) {
      const Quad quad = mesh.cell(c).quad(i);
      const auto inner = triangles_of(quad, mesh.cell(c).inner_diagonal[i]);
      if (const std::int32_t partner = mesh.partner_at(quad, c); partner != hybrid::HybridMesh::none) {
        if (mesh.cell(partner).region != mesh.cell(c).region && !tags.cover_of(quad))
          fail_conflict(names, mesh.cell(c).candidate, mesh.cell(partner).candidate,
                        "stand in two regions without an interface between them");
        if (mesh.tet_at(inner[0]) == hybrid::HybridMesh::none) continue;
        fail_conflict(names, mesh.cell(c).candidate, mesh.cell(partner).candidate, "have a tet between them");
      }
      const int diagonal = mesh.cell(c).outer_diagonal(i);
      int tets = 0;
      for (const auto& half : triangles_of(quad, diagonal)) tets += mesh.tet_at(half) != hybrid::HybridMesh::none;
      if (tets == 0 && tags.cover_of(quad, diagonal)) continue;
      const auto candidate = mesh.cell(c).candidate;
      if (tets != 2)
        throw DataError::at(names.solution,
                            "expected candidates that fit together, found {} with a quad that another crosses",
                            title_of(names, candidate));
      const auto [other, added] = diagonals.try_emplace(edge_key(quad[diagonal], quad[diagonal + 2]), candidate);
      if (!added) fail_conflict(names, other->second, candidate, "cross at an edge");
    }
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(mesh.cell_count()); ++c)
    with_topology(mesh.cell(c).kind, [&](auto topology) {
      const auto& corners = mesh.cell(c).corners;
      for (const auto& e : decltype(topology)::edges) {
        const auto found = diagonals.find(edge_key(corners[e[0]], corners[e[1]]));
        if (found != diagonals.end()) fail_conflict(names, found->second, mesh.cell(c).candidate, "cross at an edge");
      }
    });
}

}  // namespace

std::string title_of(const InputNames& names, std::int32_t candidate) {
  if (names.origins.empty()) return fmt::format("{}", candidate + 1);
  const auto& [bundle, number] = names.origins[candidate];
  return bundle == 0 ? fmt::format("{}", number + 1) : fmt::format("{} of {}", number + 1, names.bundles[bundle]);
}

bool is_formed_by_its_tets(const TetMesh& mesh, const Candidates& candidates, std::int32_t candidate) {
  return cell_of(mesh, candidates, candidate).has_value();
}

hybrid::HybridMesh build_selection(const TetMesh& mesh, const hybrid::SurfaceTags& tags, const Candidates& candidates,
                                   const graph::IndependentSet& chosen, const InputNames& names) {
  Claims claims{std::vector<std::int32_t>(mesh.tets.size(), hybrid::HybridCell::none),
                std::vector<std::uint8_t>(mesh.tets.size(), 0)};
  std::vector<hybrid::HybridCell> cells;
  cells.reserve(chosen.size());
  for (std::int32_t candidate : chosen) {
    claim_interior(names, candidates, candidate, claims);
    const auto cell = cell_of(mesh, candidates, candidate);
    if (!cell)
      throw DataError::at(names.candidates,
                          "expected candidates of this mesh, found candidate {} whose tets do not form it",
                          title_of(names, candidate));
    cells.push_back(*cell);
  }
  KeyMap<4, QuadOwner> owners;
  owners.reserve(4 * cells.size());
  pair_quads(names, cells, owners);
  absorb_slivers(names, tags, owners, cells, claims);

  std::vector<bool> removed(mesh.tets.size());
  for (std::size_t t = 0; t < removed.size(); ++t)
    removed[t] = claims.owner[t] != hybrid::HybridCell::none || claims.absorbed[t];
  hybrid::HybridMesh result(mesh, removed);
  for (const auto& cell : cells) result.add_cell(cell);
  check_open_sides(names, result, tags);
  return result;
}

bool is_open(const hybrid::HybridMesh& mesh, std::int32_t cell, int i) {
  const Quad quad = mesh.cell(cell).quad(i);
  if (mesh.partner_at(quad, cell) != hybrid::HybridMesh::none) return false;
  return mesh.tet_at(triangles_of(quad, mesh.cell(cell).outer_diagonal(i))[0]) != hybrid::HybridMesh::none;
}

std::vector<OpenQuad> open_quads(const hybrid::HybridMesh& mesh) {
  std::vector<OpenQuad> result;
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(mesh.cell_count()); ++c) {
    if (!mesh.cell(c).alive) continue;
    for (int i = 0; i < mesh.cell(c).quad_count(); ++i)
      if (is_open(mesh, c, i)) result.push_back({c, i});
  }
  return result;
}

}  // namespace hexpipe::assemble::choice
