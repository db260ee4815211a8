#include "tools/assemble/pieces/pieces.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "common/mesh/item_lists.hpp"
#include "common/mesh/joined_sets.hpp"

namespace hexpipe::assemble::pieces {
namespace {

// Open quads join only few tets. A group of more than this stays at home.
constexpr std::size_t most_together = 200;
// A part builds a tet only if one of its points is at most this many edges away. All points of the tet are then at most
// three edges away, a cell at one of its facets at most six, and so within the view.
constexpr int furthest_moved = 2;

// The open quads of some cells and the tets around their diagonals.
struct OpenRing {
  CandidateIndex cell;  // of the view
  std::vector<TetIndex> tets;
};

std::vector<OpenRing> open_rings(const hybrid::HybridMesh& mesh) {
  std::vector<OpenRing> rings;
  for (const auto& [c, i] : choice::open_quads(mesh)) {
    const hybrid::HybridCell& cell = mesh.cell(c);
    const Quad quad = cell.quad(i);
    const int diagonal = cell.outer_diagonal(i);
    OpenRing& ring = rings.emplace_back();
    ring.cell = cell.candidate;
    mesh.tets_around_edge(quad[diagonal], quad[diagonal + 2], ring.tets);
  }
  return rings;
}

std::int32_t home_of(const PartView& view, TetIndex tet) {
  const Tet& corners = view.mesh.tets[tet];
  const std::int32_t part = view.part.tet_part[tet];
  const bool has_point = std::ranges::any_of(corners, [&](Vertex v) { return view.part.point_part[v] == part; });
  return has_point ? part : view.part.point_part[corners[0]];
}

// Tets joined by rings, each group with its tets ascending.
std::vector<std::vector<TetIndex>> groups_of(const std::vector<OpenRing>& rings, std::size_t tet_count) {
  JoinedSets joined(tet_count);
  std::vector<TetIndex> tets;
  for (const OpenRing& ring : rings)
    for (const TetIndex t : ring.tets) {
      tets.push_back(t);
      joined.join(t, ring.tets.front());
    }
  sort_unique(tets);
  std::map<std::int32_t, std::vector<TetIndex>> groups;  // by the number of the set
  for (const TetIndex t : tets) groups[joined.of(t)].push_back(t);
  std::vector<std::vector<TetIndex>> result;
  result.reserve(groups.size());
  for (auto& [first, group] : groups) result.push_back(std::move(group));
  return result;
}

class Division {
 public:
  Division(const PartView& view, const TetAdjacency& adjacency, const hybrid::HybridMesh& chosen)
      : view_(view), adjacency_(adjacency), rings_(open_rings(chosen)) {
    pieces_.of_tet.resize(view.mesh.tets.size());
    for (const auto t : indices<TetIndex>(pieces_.of_tet.size())) pieces_.of_tet[t] = home_of(view, t);
  }

  void move_groups() {
    std::vector<std::vector<std::int32_t>> owners(view_.mesh.tets.size());
    for (const OpenRing& ring : rings_) owners[ring.tets.front()].push_back(view_.keys.part[ring.cell]);
    for (const auto& group : groups_of(rings_, view_.mesh.tets.size())) {
      std::map<std::int32_t, int> shares;
      for (const TetIndex t : group) {
        ++shares[pieces_.of_tet[t]];
        for (const std::int32_t part : owners[t]) ++shares[part];
      }
      if (shares.size() == 1 || group.size() > most_together) continue;
      move(group, shares);
    }
  }

  // Tets go where their homes have said.
  void hear(const RoundBefore& before) {
    for (const auto t : indices<TetIndex>(pieces_.of_tet.size())) {
      const std::int32_t home = home_of(view_, t);
      if (home == view_.part.part || !std::ranges::binary_search(before.known_homes, home)) continue;
      const auto found = std::ranges::lower_bound(before.moved_tets, view_.part.tet_number[t]);
      const bool moved = found != before.moved_tets.end() && *found == view_.part.tet_number[t];
      pieces_.of_tet[t] = moved ? before.moved_to[found - before.moved_tets.begin()] : home;
    }
  }

  void note_moved() {
    for (const auto t : indices<TetIndex>(pieces_.of_tet.size())) {
      if (pieces_.of_tet[t] == view_.part.part || home_of(view_, t) != view_.part.part) continue;
      pieces_.moved_tets.push_back(view_.part.tet_number[t]);
      pieces_.moved_to.push_back(pieces_.of_tet[t]);
    }
  }

  // A sliver between two cells goes to the lower part.
  void take_cells() {
    const Candidates& cells = view_.cells;
    for (std::size_t i = 0; i < cells.size(); ++i)
      for (const TetIndex t : cells.boundary_tets_of(i)) pieces_.of_tet[t] = view_.part.parts;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::int32_t owner = view_.keys.part[i];
      for (const TetIndex t : cells.interior_tets_of(i)) pieces_.of_tet[t] = owner;
      for (const TetIndex t : cells.boundary_tets_of(i)) pieces_.of_tet[t] = std::min(pieces_.of_tet[t], owner);
    }
  }

  Pieces take() { return std::move(pieces_); }

 private:
  bool is_near(TetIndex tet, std::int32_t part) const {
    std::vector<Vertex> reached(view_.mesh.tets[tet].begin(), view_.mesh.tets[tet].end());
    for (int step = 0;; ++step) {
      if (std::ranges::any_of(reached, [&](Vertex v) { return view_.part.point_part[v] == part; })) return true;
      if (step == furthest_moved) return false;
      std::set<Vertex> next;
      for (const Vertex v : reached)
        for (const Vertex w : adjacency_.neighbours_of(v)) next.insert(w);
      reached.assign(next.begin(), next.end());
    }
  }

  // Moves the group to the part with the most of its tets and quads among those near enough; the lowest of several.
  void move(const std::vector<TetIndex>& group, const std::map<std::int32_t, int>& shares) {
    std::vector<std::pair<int, std::int32_t>> order;
    order.reserve(shares.size());
    for (const auto& [part, share] : shares) order.emplace_back(-share, part);
    std::ranges::sort(order);
    for (const auto& [share, part] : order) {
      if (!std::ranges::all_of(group, [&](TetIndex t) { return is_near(t, part); })) continue;
      for (const TetIndex t : group) pieces_.of_tet[t] = part;
      return;
    }
  }

  const PartView& view_;
  const TetAdjacency& adjacency_;
  std::vector<OpenRing> rings_;
  Pieces pieces_;
};

std::vector<CandidateIndex> all_but(const PartView& view, std::span<const std::uint64_t> given_back) {
  std::vector<CandidateIndex> rest;
  for (const auto i : indices<CandidateIndex>(view.cells.size()))
    if (!std::ranges::binary_search(given_back, view.keys.key[i])) rest.push_back(i);
  return rest;
}

}  // namespace

Pieces divide_tets(const PartView& view, const hybrid::SurfaceTags& tags, const TetAdjacency& adjacency,
                   const RoundBefore& before, const choice::InputNames& names) {
  const choice::Selection selection(view.mesh, tags, view.cells, choice::all_of(view.cells), names);
  Division division(view, adjacency, selection.mesh());
  division.move_groups();
  division.note_moved();
  division.hear(before);
  division.take_cells();
  return division.take();
}

SeamCells cells_at_seams(const PartView& view, const hybrid::SurfaceTags& tags, const Pieces& pieces,
                         std::span<const std::uint64_t> given_back, const choice::InputNames& names) {
  SeamCells result;
  const std::int32_t here = view.part.part;
  const auto is_own = [&](CandidateIndex i) { return view.keys.part[i] == here; };
  std::vector<CandidateIndex> left = all_but(view, given_back);
  for (bool changed = true; changed;) {
    changed = false;
    result.guests.clear();
    const choice::Selection selection(view.mesh, tags, view.cells, left, names);
    std::set<CandidateIndex> torn, guests;
    for (const OpenRing& ring : open_rings(selection.mesh())) {
      const std::int32_t piece = pieces.of_tet[ring.tets.front()];
      const bool in_one = std::ranges::all_of(ring.tets, [&](TetIndex t) { return pieces.of_tet[t] == piece; });
      if (!in_one)
        torn.insert(ring.cell);
      else if (piece == here && !is_own(ring.cell))
        guests.insert(ring.cell);
    }
    for (const CandidateIndex i : guests)
      if (!torn.contains(i)) result.guests.push_back(i);
    const auto goes_back = [&](CandidateIndex i) { return is_own(i) && torn.contains(i); };
    changed = std::ranges::any_of(left, goes_back);
    std::ranges::copy_if(left, std::back_inserter(result.given_back), goes_back);
    std::erase_if(left, goes_back);
  }
  std::ranges::copy_if(left, std::back_inserter(result.own), is_own);
  std::ranges::sort(result.given_back);
  return result;
}

}  // namespace hexpipe::assemble::pieces
