#include "tools/assemble/choice/selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "common/run/error.hpp"

namespace hexpipe::assemble::choice {
namespace {

// Which candidate's cell replaces a tet, if any, and whether cells absorb it as a sliver.
struct Claims {
  IndexedVector<TetIndex, CandidateIndex> owner;
  IndexedVector<TetIndex, std::uint8_t> absorbed;
};

// The chosen cells, with the numbers that they will have in the mesh.
using ChosenCells = IndexedVector<CellIndex, hybrid::HybridCell>;

[[noreturn]] void fail_conflict(const InputNames& names, CandidateIndex a, CandidateIndex b, const char* how) {
  throw DataError::at(names.solution, "expected candidates that fit together, found {} and {} which {}",
                      title_of(names, a), title_of(names, b), how);
}

void claim_interior(const InputNames& names, const Candidates& candidates, CandidateIndex candidate, Claims& claims) {
  for (TetIndex t : candidates.interior_tets_of(candidate)) {
    if (claims.owner[t] != no_index) fail_conflict(names, claims.owner[t], candidate, "share a tet");
    claims.owner[t] = candidate;
  }
}

// The facets that no two of the interior tets share: the skin of what the cell replaces. There are at most 15 tets, for
// which a quadratic search is the fastest.
std::vector<VertexKey<3>> skin_of(const TetMesh& mesh, std::span<const TetIndex> tets) {
  std::vector<VertexKey<3>> skin;
  for (TetIndex t : tets)
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

// Finds each facet of the cell on the skin, and each quad's diagonal. False if the skin is not the cell's.
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

// The cell that the candidate's tets form, if they do.
std::optional<hybrid::HybridCell> cell_of(const TetMesh& mesh, const Candidates& candidates, CandidateIndex candidate) {
  const auto interior = candidates.interior_tets_of(candidate);
  if (interior.empty() || candidates.kind[candidate] == CellKind::tet) return std::nullopt;
  hybrid::HybridCell cell;
  cell.kind = candidates.kind[candidate];
  cell.corners = candidates.vertices[candidate];
  cell.candidate = candidate;
  cell.region = mesh.tet_tags[interior.front()];
  for (TetIndex t : interior)
    if (mesh.tet_tags[t] != cell.region) return std::nullopt;
  const auto skin = skin_of(mesh, interior);
  if (!with_topology(cell.kind, [&](auto topology) { return match_skin<decltype(topology)>(skin, cell); }))
    return std::nullopt;
  for (TetIndex t : candidates.boundary_tets_of(candidate)) {
    const int quad = quad_with_vertices(cell, key_of(mesh.tets[t]));
    if (quad < 0 || cell.sliver[quad] != no_index || mesh.tet_tags[t] != cell.region) return std::nullopt;
    cell.sliver[quad] = t;
  }
  return cell;
}

// The chosen cells at a quad: a third one is an error, and so is another cyclic order.
struct QuadOwner {
  CellIndex cell;
  Quad quad;
  CellIndex partner = no_index;
};

void pair_quads(const InputNames& names, const ChosenCells& cells, KeyMap<4, QuadOwner>& owners) {
  for (const auto c : indices<CellIndex>(cells.size()))
    for (int i = 0; i < cells[c].quad_count(); ++i) {
      const Quad quad = cells[c].quad(i);
      auto [entry, added] = owners.try_emplace(key_of(quad), QuadOwner{c, quad});
      if (added) continue;
      QuadOwner& owner = entry.value();
      if (owner.partner != no_index || !same_diagonals(owner.quad, quad))
        fail_conflict(names, cells[owner.cell].candidate, cells[c].candidate, "cross at a quad");
      owner.partner = c;
    }
}

void absorb_slivers(const InputNames& names, const hybrid::SurfaceTags& tags, const KeyMap<4, QuadOwner>& owners,
                    ChosenCells& cells, Claims& claims) {
  for (auto& cell : cells)
    for (int i = 0; i < cell.quad_count(); ++i) {
      TetIndex& sliver = cell.sliver[i];
      if (sliver == no_index) continue;
      if (claims.owner[sliver] != no_index) fail_conflict(names, claims.owner[sliver], cell.candidate, "share a tet");
      const bool alone = owners.at(key_of(cell.quad(i))).partner == no_index;
      if (alone && tags.covers_partly(cell.quad(i), cell.outer_diagonal(i)))
        sliver = no_index;
      else
        claims.absorbed[sliver] = 1;
    }
}

// At a quad of two cells there is no tet between them, and in two regions there is an interface.
void check_pair(const InputNames& names, const hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags,
                const OpenQuad& at, CellIndex partner) {
  const hybrid::HybridCell &cell = mesh.cell(at.cell), &other = mesh.cell(partner);
  const Quad quad = cell.quad(at.quad);
  if (other.region != cell.region && !tags.cover_of(quad))
    fail_conflict(names, cell.candidate, other.candidate, "stand in two regions without an interface between them");
  if (mesh.tet_at(triangles_of(quad, cell.inner_diagonal[at.quad])[0]) != no_index)
    fail_conflict(names, cell.candidate, other.candidate, "have a tet between them");
}

// Whether both halves of a quad of one cell face tets. If they do not, both lie on the boundary, or another cell
// crosses the quad.
bool faces_tets(const InputNames& names, const hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags,
                const OpenQuad& at) {
  const hybrid::HybridCell& cell = mesh.cell(at.cell);
  const Quad quad = cell.quad(at.quad);
  const int diagonal = cell.outer_diagonal(at.quad);
  int tets = 0;
  for (const auto& half : triangles_of(quad, diagonal)) tets += mesh.tet_at(half) != no_index;
  if (tets == 0 && tags.cover_of(quad, diagonal)) return false;
  if (tets == 2) return true;
  throw DataError::at(names.solution,
                      "expected candidates that fit together, found {} with a quad that another crosses",
                      title_of(names, cell.candidate));
}

// The candidates at the diagonals of open quads, after checking both sides of every quad. Conformity is going to split
// these diagonals, so no two quads may have one in common.
KeyMap<2, CandidateIndex> check_quads(const InputNames& names, const hybrid::HybridMesh& mesh,
                                      const hybrid::SurfaceTags& tags) {
  KeyMap<2, CandidateIndex> diagonals;
  for (const auto c : indices<CellIndex>(mesh.cell_count()))
    for (int i = 0; i < mesh.cell(c).quad_count(); ++i) {
      const hybrid::HybridCell& cell = mesh.cell(c);
      const Quad quad = cell.quad(i);
      if (const CellIndex partner = mesh.partner_at(quad, c); partner != no_index) {
        check_pair(names, mesh, tags, {c, i}, partner);
        continue;
      }
      if (!faces_tets(names, mesh, tags, {c, i})) continue;
      const int diagonal = cell.outer_diagonal(i);
      const auto [other, added] = diagonals.try_emplace(edge_key(quad[diagonal], quad[diagonal + 2]), cell.candidate);
      if (!added) fail_conflict(names, other->second, cell.candidate, "cross at an edge");
    }
  return diagonals;
}

// No cell has an edge that is the diagonal of an open quad.
void check_edges(const InputNames& names, const hybrid::HybridMesh& mesh, const KeyMap<2, CandidateIndex>& diagonals) {
  for (const auto c : indices<CellIndex>(mesh.cell_count()))
    with_topology(mesh.cell(c).kind, [&](auto topology) {
      const auto& corners = mesh.cell(c).corners;
      for (const auto& e : decltype(topology)::edges) {
        const auto found = diagonals.find(edge_key(corners[e[0]], corners[e[1]]));
        if (found != diagonals.end()) fail_conflict(names, found->second, mesh.cell(c).candidate, "cross at an edge");
      }
    });
}

}  // namespace

std::string title_of(const InputNames& names, CandidateIndex candidate) {
  if (names.origins.empty()) return fmt::format("{}", candidate + 1);
  const auto& [bundle, number] = names.origins[candidate];
  return bundle == 0 ? fmt::format("{}", number + 1) : fmt::format("{} of {}", number + 1, names.bundles[bundle]);
}

std::vector<CandidateIndex> all_of(const Candidates& candidates) {
  std::vector<CandidateIndex> all(candidates.size());
  std::iota(all.begin(), all.end(), CandidateIndex(0));
  return all;
}

bool is_formed_by_its_tets(const TetMesh& mesh, const Candidates& candidates, CandidateIndex candidate) {
  return cell_of(mesh, candidates, candidate).has_value();
}

namespace {

hybrid::HybridMesh select_cells(const TetMesh& mesh, const hybrid::SurfaceTags& tags, const Candidates& candidates,
                                const std::vector<CandidateIndex>& chosen, const InputNames& names) {
  Claims claims;
  claims.owner.resize(mesh.tets.size());
  claims.absorbed.resize(mesh.tets.size());
  ChosenCells cells;
  cells.reserve(chosen.size());
  for (CandidateIndex candidate : chosen) {
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
  for (const auto t : indices<TetIndex>(removed.size())) removed[t] = claims.owner[t] != no_index || claims.absorbed[t];
  hybrid::HybridMesh result(mesh, removed);
  for (const auto& cell : cells) result.add_cell(cell);
  check_edges(names, result, check_quads(names, result, tags));
  return result;
}

}  // namespace

Selection::Selection(const TetMesh& mesh, const hybrid::SurfaceTags& tags, const Candidates& candidates,
                     std::vector<CandidateIndex> chosen, const InputNames& names)
    : choice_(std::move(chosen)), mesh_(select_cells(mesh, tags, candidates, choice_.chosen(), names)) {}

bool is_open(const hybrid::HybridMesh& mesh, CellIndex cell, int i) {
  const Quad quad = mesh.cell(cell).quad(i);
  if (mesh.partner_at(quad, cell) != no_index) return false;
  return mesh.tet_at(triangles_of(quad, mesh.cell(cell).outer_diagonal(i))[0]) != no_index;
}

std::vector<OpenQuad> open_quads(const hybrid::HybridMesh& mesh) {
  std::vector<OpenQuad> result;
  for (const auto c : indices<CellIndex>(mesh.cell_count())) {
    if (!mesh.cell(c).alive) continue;
    for (int i = 0; i < mesh.cell(c).quad_count(); ++i)
      if (is_open(mesh, c, i)) result.push_back({c, i});
  }
  return result;
}

}  // namespace hexpipe::assemble::choice
