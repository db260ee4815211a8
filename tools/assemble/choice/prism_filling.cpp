// Where two sheets of hexes end against each other, there is often a row of wedges between them. A wedge of tets takes
// two pyramids, a prism none. The tets that are left are a mesh of their own, small beside the whole, so that the
// search for prisms in it and the conflict graph take little time.

#include "tools/assemble/choice/prism_filling.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "common/candidates/findhex.hpp"
#include "common/conflicts/find_conflicts.hpp"
#include "common/mesh/face_view.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/quality.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"

namespace hexpipe::assemble::choice {
namespace {

constexpr const char* source = "tets between cells";

// The tets that no cell replaces or absorbs, and their numbers in `mesh`.
struct LeftTets {
  TetMesh mesh;
  std::vector<TetIndex> number;
};

LeftTets left_tets(const TetMesh& mesh, const hybrid::HybridMesh& selected) {
  LeftTets left;
  left.mesh.points = mesh.points;
  left.mesh.triangles = mesh.triangles;
  left.mesh.triangle_tags = mesh.triangle_tags;
  for (const auto t : indices<TetIndex>(mesh.tets.size())) {
    if (!selected.is_alive(t)) continue;
    left.mesh.tets.push_back(mesh.tets[t]);
    left.mesh.tet_tags.push_back(mesh.tet_tags[t]);
    left.number.push_back(t);
  }
  return left;
}

// All prisms that the tets left could become and that no reader would turn round, with the numbers of `mesh`.
Candidates prisms_between(const TetMesh& mesh, const hybrid::HybridMesh& selected) {
  LeftTets left = left_tets(mesh, selected);
  Candidates prisms;
  if (left.number.empty()) return prisms;
  const Candidates found = candidates::findhex(std::move(left.mesh), {.kinds = {CellKind::prism}}, source).candidates;
  const auto same = [](Vertex v) { return v; };
  const auto in_mesh = [&](TetIndex t) { return left.number[t]; };
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!looks_inverted(CellKind::prism, mesh.points, std::span(found.vertices[i]).first(6)))
      append_candidate(prisms, found, i, same, in_mesh, in_mesh);
  }
  return prisms;
}

std::array<Quad, PrismTopology::quads.size()> quads_of_prism(const Candidates& candidates, CandidateIndex prism) {
  hybrid::HybridCell cell;
  cell.kind = CellKind::prism;
  cell.corners = candidates.vertices[prism];
  return {cell.quad(0), cell.quad(1), cell.quad(2)};
}

// The cells that have a vertex of a prism. The others are in conflict with none, and have none of their quads.
Candidates cells_beside(const Candidates& prisms, const Candidates& cells, std::size_t vertices) {
  std::vector<bool> is_at_prism(vertices);
  for (const auto i : indices<CandidateIndex>(prisms.size()))
    for (const Vertex v : prisms.corners_of(i)) is_at_prism[v] = true;
  std::vector<CandidateIndex> beside;
  for (const auto i : indices<CandidateIndex>(cells.size()))
    if (std::ranges::any_of(cells.corners_of(i), [&](Vertex v) { return is_at_prism[v]; })) beside.push_back(i);
  return select(cells, beside);
}

// Takes prisms one by one. Each time it takes the prism that closes the most quads, less the quads that it opens; among
// several, the prism of the best quality. It also takes prisms that close as many as they open, because a prism is
// better than its tets.
class Filling {
 public:
  // `all` holds the chosen cells beside the prisms and, from `first` on, the prisms; `graph` their conflicts.
  Filling(const hybrid::BoundaryQuads& boundary, const Candidates& all, const graph::ConflictGraph& graph,
          std::size_t first)
      : boundary_(boundary), all_(all), graph_(graph), barred_(all.size()) {
    for (const auto i : indices<CandidateIndex>(first)) take(i);
    for (const auto i : indices<CandidateIndex>(first, all.size()))
      for (const Quad& quad : quads_of_prism(all, i)) prisms_at_[key_of(quad)].push_back(i);
    for (const auto i : indices<CandidateIndex>(first, all.size())) offer(i);
  }

  // The prisms taken, ascending.
  std::vector<CandidateIndex> run() {
    std::vector<CandidateIndex> taken;
    while (!offers_.empty()) {
      const Offer best = offers_.top();
      offers_.pop();
      // If its gain has changed since, it was offered again.
      if (barred_[best.prism] || best.gain != gain_of(best.prism)) continue;
      take(best.prism);
      taken.push_back(best.prism);
      for (const Quad& quad : quads_of_prism(all_, best.prism))
        for (const CandidateIndex beside : prisms_at_.at(key_of(quad))) offer(beside);
    }
    std::ranges::sort(taken);
    return taken;
  }

 private:
  struct Offer {
    int gain;
    double quality;
    CandidateIndex prism;
    bool operator<(const Offer& other) const {
      if (gain != other.gain) return gain < other.gain;
      if (quality != other.quality) return quality < other.quality;
      return prism > other.prism;
    }
  };

  void take(CandidateIndex i) {
    hybrid::HybridCell cell;
    cell.kind = all_.kind[i];
    cell.corners = all_.vertices[i];
    for (int k = 0; k < cell.quad_count(); ++k) quads_.insert(key_of(cell.quad(k)));
    barred_[i] = true;
    for (const std::int32_t other : graph_.neighbours_of(i)) barred_[other] = true;
  }

  int gain_of(CandidateIndex prism) const {
    int gain = 0;
    for (const Quad& quad : quads_of_prism(all_, prism)) {
      if (quads_.contains(key_of(quad)))
        ++gain;
      else if (!boundary_.contains(quad))
        --gain;
    }
    return gain;
  }

  void offer(CandidateIndex prism) {
    if (barred_[prism]) return;
    if (const int gain = gain_of(prism); gain >= 0) offers_.push({gain, all_.quality[prism], prism});
  }

  const hybrid::BoundaryQuads& boundary_;
  const Candidates& all_;
  const graph::ConflictGraph& graph_;
  std::vector<bool> barred_;  // taken, or in conflict with one that is
  KeySet<4> quads_;           // of all cells taken
  KeyMap<4, std::vector<CandidateIndex>> prisms_at_;
  std::priority_queue<Offer> offers_;
};

}  // namespace

PrismFilling fill_with_prisms(const TetMesh& mesh, const hybrid::BoundaryQuads& boundary, const Candidates& candidates,
                              const Selection& selection) {
  PrismFilling result{select(candidates, selection.chosen())};
  const Candidates prisms = prisms_between(mesh, selection.mesh());
  if (prisms.size() == 0) return result;
  Candidates all = cells_beside(prisms, result.cells, mesh.points.size());
  const std::size_t first_prism = all.size();
  append(all, prisms);
  const graph::ConflictGraph graph =
      conflicts::conflict_graph(all, {.weight = conflicts::WeightKind::count, .weight_scale = 1}, source);
  const auto taken = Filling(boundary, all, graph, first_prism).run();
  append(result.cells, select(all, taken));
  result.prisms = static_cast<std::int64_t>(taken.size());
  return result;
}

}  // namespace hexpipe::assemble::choice
