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
class Skin {
 public:
  void collect(const TetMesh& mesh, std::span<const TetIndex> tets);
  std::size_t size() const { return facets_.size(); }
  bool has(const Triangle& triangle) const { return place_of(key_of(triangle)) != facets_.size(); }
  bool has_both(const std::array<Triangle, 2>& triangles) const { return has(triangles[0]) && has(triangles[1]); }

 private:
  std::size_t place_of(const VertexKey<3>& key) const {
    std::size_t place = 0;
    while (place < facets_.size() && !SameVertexKey<3>()(facets_[place], key)) ++place;
    return place;
  }

  std::vector<VertexKey<3>> facets_;
  std::vector<Tet> tets_;
};

void Skin::collect(const TetMesh& mesh, std::span<const TetIndex> tets) {
  facets_.clear();
  facets_.reserve(4 * tets.size());
  // They lie apart from each other, and reading them takes most of the time: less if all are asked for at once.
  tets_.clear();
  for (const TetIndex t : tets) tets_.push_back(mesh.tets[t]);
  for (const Tet& tet : tets_)
    for (const auto& f : TetTopology::triangles) {
      const auto key = key_of(Triangle{tet[f[0]], tet[f[1]], tet[f[2]]});
      if (const std::size_t twin = place_of(key); twin == facets_.size()) {
        facets_.push_back(key);
      } else {
        facets_[twin] = facets_.back();
        facets_.pop_back();
      }
    }
}

// Finds each facet of the cell on the skin, and each quad's diagonal. False if the skin is not the cell's.
template <class Topology>
bool match_skin(const Skin& skin, hybrid::HybridCell& cell) {
  if (skin.size() != Topology::triangles.size() + 2 * Topology::quads.size()) return false;
  for (const auto& f : Topology::triangles)
    if (!skin.has({cell.corners[f[0]], cell.corners[f[1]], cell.corners[f[2]]})) return false;
  for (int i = 0; i < static_cast<int>(Topology::quads.size()); ++i) {
    const Quad quad = cell.quad(i);
    const bool first = skin.has_both(triangles_of(quad, 0));
    if (!first && !skin.has_both(triangles_of(quad, 1))) return false;
    cell.inner_diagonal[i] = first ? 0 : 1;
  }
  return true;
}

int quad_with_vertices(const hybrid::HybridCell& cell, const VertexKey<4>& key) {
  for (int i = 0; i < cell.quad_count(); ++i)
    if (SameVertexKey<4>()(key_of(cell.quad(i)), key)) return i;
  return -1;
}

// The cell that the candidate's tets form, if they do. `skin` is room for this.
std::optional<hybrid::HybridCell> cell_of(const TetMesh& mesh, const Candidates& candidates, CandidateIndex candidate,
                                          Skin& skin) {
  const auto interior = candidates.interior_tets_of(candidate);
  if (interior.empty() || candidates.kind[candidate] == CellKind::tet) return std::nullopt;
  hybrid::HybridCell cell;
  cell.kind = candidates.kind[candidate];
  cell.corners = candidates.vertices[candidate];
  cell.candidate = candidate;
  cell.region = mesh.tet_tags[interior.front()];
  for (TetIndex t : interior)
    if (mesh.tet_tags[t] != cell.region) return std::nullopt;
  skin.collect(mesh, interior);
  if (!with_topology(cell.kind, [&](auto topology) { return match_skin<decltype(topology)>(skin, cell); }))
    return std::nullopt;
  for (TetIndex t : candidates.boundary_tets_of(candidate)) {
    const int quad = quad_with_vertices(cell, key_of(mesh.tets[t]));
    if (quad < 0 || cell.sliver[quad] != no_index || mesh.tet_tags[t] != cell.region) return std::nullopt;
    cell.sliver[quad] = t;
  }
  return cell;
}

// The quads of the chosen cells. A third cell at a quad is an error, and so is another cyclic order.
hybrid::CellQuads pair_quads(const InputNames& names, std::size_t vertices, const ChosenCells& cells) {
  hybrid::CellQuads quads(vertices);
  quads.reserve(cells.size(), 6 * cells.size());
  for (const auto c : indices<CellIndex>(cells.size())) {
    std::array<VertexKey<4>, 6> room;
    const auto keys = cells[c].quad_keys(room);
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const auto [first, second] = quads.cells_at(keys[i]);
      if (first == no_index) continue;
      const Quad other = cells[first].quad(quad_with_vertices(cells[first], keys[i]));
      if (second != no_index || !same_diagonals(other, cells[c].quad(static_cast<int>(i))))
        fail_conflict(names, cells[first].candidate, cells[c].candidate, "cross at a quad");
    }
    quads.add(c, keys);
  }
  return quads;
}

void absorb_slivers(const InputNames& names, const hybrid::SurfaceTags& tags, const hybrid::CellQuads& quads,
                    ChosenCells& cells, Claims& claims) {
  for (const auto c : indices<CellIndex>(cells.size())) {
    hybrid::HybridCell& cell = cells[c];
    for (int i = 0; i < cell.quad_count(); ++i) {
      TetIndex& sliver = cell.sliver[i];
      if (sliver == no_index) continue;
      if (claims.owner[sliver] != no_index) fail_conflict(names, claims.owner[sliver], cell.candidate, "share a tet");
      if (quads.partner(c, i) == no_index && tags.covers_partly(cell.quad(i), cell.outer_diagonal(i)))
        sliver = no_index;
      else
        claims.absorbed[sliver] = 1;
    }
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
      if (const CellIndex partner = mesh.partner_at(c, i); partner != no_index) {
        check_pair(names, mesh, tags, {c, i}, partner);
        continue;
      }
      if (!faces_tets(names, mesh, tags, {c, i})) continue;
      const Quad quad = cell.quad(i);
      const int diagonal = cell.outer_diagonal(i);
      const auto [other, added] = diagonals.try_emplace(edge_key(quad[diagonal], quad[diagonal + 2]), cell.candidate);
      if (!added) fail_conflict(names, other->second, cell.candidate, "cross at an edge");
    }
  return diagonals;
}

// No cell has an edge that is the diagonal of an open quad.
void check_edges(const InputNames& names, const hybrid::HybridMesh& mesh, const KeyMap<2, CandidateIndex>& diagonals) {
  // Most vertices are at none.
  std::vector<bool> is_at_diagonal(mesh.points.size());
  for (const auto& [diagonal, candidate] : diagonals)
    for (const Vertex v : diagonal) is_at_diagonal[v] = true;
  for (const auto c : indices<CellIndex>(mesh.cell_count()))
    with_topology(mesh.cell(c).kind, [&](auto topology) {
      const auto& corners = mesh.cell(c).corners;
      for (const auto& e : decltype(topology)::edges) {
        if (!is_at_diagonal[corners[e[0]]] || !is_at_diagonal[corners[e[1]]]) continue;
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
  Skin skin;
  return cell_of(mesh, candidates, candidate, skin).has_value();
}

namespace {

hybrid::HybridMesh select_cells(const TetMesh& mesh, const hybrid::SurfaceTags& tags, const Candidates& candidates,
                                const std::vector<CandidateIndex>& chosen, const InputNames& names) {
  Claims claims;
  claims.owner.resize(mesh.tets.size());
  claims.absorbed.resize(mesh.tets.size());
  ChosenCells cells;
  cells.reserve(chosen.size());
  Skin skin;
  for (CandidateIndex candidate : chosen) {
    claim_interior(names, candidates, candidate, claims);
    const auto cell = cell_of(mesh, candidates, candidate, skin);
    if (!cell)
      throw DataError::at(names.candidates,
                          "expected candidates of this mesh, found candidate {} whose tets do not form it",
                          title_of(names, candidate));
    cells.push_back(*cell);
  }
  hybrid::CellQuads quads = pair_quads(names, mesh.points.size(), cells);
  absorb_slivers(names, tags, quads, cells, claims);

  std::vector<bool> removed(mesh.tets.size());
  for (const auto t : indices<TetIndex>(removed.size())) removed[t] = claims.owner[t] != no_index || claims.absorbed[t];
  hybrid::HybridMesh result(mesh, removed, std::move(cells), std::move(quads));
  check_edges(names, result, check_quads(names, result, tags));
  return result;
}

}  // namespace

Selection::Selection(const TetMesh& mesh, const hybrid::SurfaceTags& tags, const Candidates& candidates,
                     std::vector<CandidateIndex> chosen, const InputNames& names)
    : choice_(std::move(chosen)), mesh_(select_cells(mesh, tags, candidates, choice_.chosen(), names)) {}

bool is_open(const hybrid::HybridMesh& mesh, CellIndex cell, int i) {
  if (mesh.partner_at(cell, i) != no_index) return false;
  const Quad quad = mesh.cell(cell).quad(i);
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
