#include "tools/assemble/attempt.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "common/mesh/face_view.hpp"
#include "common/mesh/item_lists.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/run/error.hpp"
#include "common/run/progress.hpp"
#include "tools/assemble/conform/flat_tets.hpp"
#include "tools/assemble/gap/fewer_cells.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe::assemble {
namespace {

// New elements may be this inverted before smoothing: untangling has been seen to fail beyond it.
constexpr double most_inverted = -0.3;
// Without smoothing, new elements only have to be valid, with room for rounding.
constexpr double barely_valid = 1e-4;
constexpr int untangling_rounds = 20;
// Attempts to conform and untangle without poor elements, and attempts to smooth without poor hexes and inverted
// prisms. Two are nearly always enough; the last one takes no risks.
constexpr int most_attempts = 4;
// Rounds of making the cells between the hexes fewer, each followed by smoothing: a fourth finds a seventh of what the
// third does.
constexpr int most_merging_rounds = 3;
// Rounds of smoothing after all but the first of these: five leave no fewer cells and no better ones, and assemble
// takes a tenth longer.
constexpr int rounds_between_merges = 2;
// Rounds of smoothing where cells are good already, at the end: a fourth and fifth find nothing more.
constexpr int polishing_rounds = 3;
// Rounds of flips, new vertices and peeling.
constexpr int most_mending_rounds = 4;
// Shares of the time that an attempt takes, for the line of progress.
constexpr double conforming_ends = 0.33, merging_ends = 0.83, mending_ends = 0.91, polishing_ends = 0.97;
// Tets that smoothing leaves below the first are flipped. Those that are then below the second get a vertex beside
// them.
constexpr double worth_a_flip = 0.15;
constexpr double worth_a_vertex = 0.05;
// Tets below this are peeled off the boundary.
constexpr double worth_peeling = 0.1;

void move_points(const hybrid::Extract& from, hybrid::HybridMesh& to) {
  for (std::size_t i = 0; i < from.origin.size(); ++i) to.points[from.origin[i]] = from.mesh.points[i];
}

// Counts what smoothing did; the mesh gets its vertices' new places.
void take_over(const shape::SmoothCounts& counts, Attempt& attempt) {
  attempt.improvement.rounds += counts.rounds;
  attempt.improvement.moves += counts.moves;
  move_points(attempt.extracted, attempt.mesh);
}

bool is_worse(const hybrid::HybridMesh& mesh, CellKind kind, std::span<const Vertex> corners, double limit) {
  const auto at = corner_points(mesh.points, corners);
  const double scale = kind == CellKind::tet ? std::sqrt(2.0) : 1;
  return scale * least_corner_scaled_jacobian(kind, std::span<const Vec3>(at).first(corners.size())) < limit;
}

bool looks_inverted(const hybrid::HybridMesh& mesh, const hybrid::HybridCell& cell) {
  const std::span corners = std::span(cell.corners).first(static_cast<std::size_t>(corner_count(cell.kind)));
  return hexpipe::looks_inverted(cell.kind, mesh.points, corners);
}

// Candidates whose cells are in the mesh, or went back to their tets.
void append_candidates(const hybrid::HybridMesh& mesh, bool alive, std::vector<CandidateIndex>& out) {
  for (const auto c : indices<CellIndex>(mesh.cell_count()))
    if (const hybrid::HybridCell& cell = mesh.cell(c); cell.alive == alive && cell.candidate != no_index)
      out.push_back(cell.candidate);
}

// By point: the candidate to whose quad the pyramid with this apex belongs. Appends the owners of poor pyramids.
std::vector<CandidateIndex> owners_of_apexes(const hybrid::HybridMesh& mesh,
                                             std::vector<CandidateIndex>& owners_of_poor) {
  std::vector<CandidateIndex> owner_of_point(mesh.points.size(), no_index);
  for (const auto c : indices<CellIndex>(mesh.cell_count())) {
    const hybrid::HybridCell& cell = mesh.cell(c);
    if (!cell.alive || cell.candidate != no_index) continue;
    const CandidateIndex owner = mesh.cell(mesh.partner_at(c, 0)).candidate;
    owner_of_point[cell.corners[4]] = owner;
    if (is_worse(mesh, cell.kind, std::span(cell.corners).first(5), shape::poor_quality))
      owners_of_poor.push_back(owner);
  }
  return owner_of_point;
}

// The candidates to which poor pyramids and poor tets made for conformity belong. An inverted tet at a vertex without a
// pyramid was made for a cell that has gone back since: then all of these count, so that they are left out from the
// start.
std::vector<CandidateIndex> owners_of_poor_elements(const hybrid::HybridMesh& mesh, std::size_t input_points) {
  std::vector<CandidateIndex> owners;
  const std::vector<CandidateIndex> owner_of_point = owners_of_apexes(mesh, owners);
  for (const auto t : indices<TetIndex>(mesh.tet_count())) {
    if (!mesh.is_alive(t)) continue;
    // The vertex added last made the tet.
    const Vertex newest = *std::ranges::max_element(mesh.tet(t));
    if (static_cast<std::size_t>(newest) < input_points) continue;
    const bool has_owner = owner_of_point[newest] != no_index;
    if (!is_worse(mesh, CellKind::tet, mesh.tet(t), has_owner ? shape::poor_quality : barely_valid)) continue;
    if (has_owner)
      owners.push_back(owner_of_point[newest]);
    else
      append_candidates(mesh, false, owners);
  }
  sort_unique(owners);
  return owners;
}

class Builder {
 public:
  Builder(const AssembleInput& input, const Candidates& candidates, const BuildRules& rules,
          const choice::InputNames& names)
      : input_(input), candidates_(candidates), rules_(rules), names_(names) {}

  Built run(AttemptStart start) const;

 private:
  shape::SlidingSurface sliding(const hybrid::Extract& extracted) const {
    return {input_.surface, input_.mesh.points, extracted.origin, rules_.is_shared()};
  }
  std::vector<CandidateIndex> conform(Attempt& attempt, bool is_last) const;
  void untangle_in_place(Attempt& attempt) const;
  void smooth_and_mend(Attempt& attempt) const;
  gap::FewerCells make_fewer_cells(Attempt& attempt, gap::Passes passes) const;
  void merge_and_smooth(Attempt& attempt) const;
  void mend(Attempt& attempt) const;
  void improve(Attempt& attempt, int rounds) const;
  void polish(Attempt& attempt) const;
  bool mend_flat_tets(Attempt& attempt) const;
  std::vector<CandidateIndex> poor_candidates(const hybrid::HybridMesh& mesh) const;
  void check_cells_left(const hybrid::HybridMesh& mesh) const;
  Attempt without(std::vector<CandidateIndex>& kept, const std::vector<CandidateIndex>& given_back) const;
  Built finish(Attempt attempt, const GivenBackCounts& given_back) const;

  const AssembleInput& input_;
  const Candidates& candidates_;
  const BuildRules& rules_;
  const choice::InputNames& names_;
};

// Leaves inverted elements where nothing better is found, unless it is the last attempt, and untangles them. Returns
// the candidates for which that does not succeed.
std::vector<CandidateIndex> Builder::conform(Attempt& attempt, bool is_last) const {
  if (!rules_.is_conforming) return {};
  const Step step("making quads meet", 0, conforming_ends);
  attempt.conformity =
      conform::make_conforming(attempt.mesh, attempt.tags, candidates_, is_last ? barely_valid : most_inverted);
  if (is_last) return {};
  const std::size_t points = input_.mesh.points.size();
  untangle_in_place(attempt);
  if (!owners_of_poor_elements(attempt.mesh, points).empty() &&
      conform::flip_poor_tets(attempt.mesh, attempt.tags, worth_a_vertex) > 0)
    untangle_in_place(attempt);
  return owners_of_poor_elements(attempt.mesh, points);
}

void Builder::untangle_in_place(Attempt& attempt) const {
  hybrid::Extract extracted = hybrid::extract(attempt.mesh, attempt.tags);
  const shape::SlidingSurface surface = sliding(extracted);
  shape::untangle(extracted.mesh, untangling_rounds, &surface);
  move_points(extracted, attempt.mesh);
}

gap::FewerCells Builder::make_fewer_cells(Attempt& attempt, gap::Passes passes) const {
  const Step step("making the cells between hexes fewer", 0, 0.4);
  const gap::FewerCells fewer =
      gap::make_fewer_cells(attempt.mesh, {attempt.tags, input_.surface}, rules_.is_shared(), passes);
  attempt.improvement.fewer += fewer;
  conform::ConformityCounts& counts = attempt.conformity;
  for (const CellIndex c : fewer.opened) {
    const hybrid::HybridCell& cell = attempt.mesh.cell(c);
    ++counts.given_back[static_cast<std::size_t>(conform::GivenBack::poor_elements)];
    if (cell.kind == CellKind::hex && cell.candidate != no_index)
      counts.volume_given_back += candidates_.volume[cell.candidate];
  }
  return fewer;
}

// Fewer cells first, quickly, so that less is smoothed; then again where vertices are in good places.
void Builder::merge_and_smooth(Attempt& attempt) const {
  Step step(nullptr, conforming_ends, merging_ends);
  step.expect(most_merging_rounds);
  for (int round = 0; round < most_merging_rounds; ++round, step.advance()) {
    const bool is_first = round == 0;
    const auto fewer = make_fewer_cells(attempt, is_first ? gap::Passes::merge : gap::Passes::merge_and_refill);
    if (!fewer.any() && !is_first) break;
    attempt.extracted = hybrid::extract(attempt.mesh, attempt.tags);
    improve(attempt, is_first ? rules_.smooth_rounds : std::min(rules_.smooth_rounds, rounds_between_merges));
  }
}

// Moves vertices, then mends flat tets; again while poor cells are left.
void Builder::smooth_and_mend(Attempt& attempt) const {
  hybrid::Extract& extracted = attempt.extracted;
  extracted = hybrid::extract(attempt.mesh, attempt.tags);
  if (rules_.smooth_rounds == 0) return;
  compute_quality(extracted.mesh);
  attempt.before_smoothing =
      kind_statistics(rules_.seam == nullptr ? extracted.mesh : hybrid::without_guests(extracted, *rules_.seam).mesh);
  if (rules_.merges)
    merge_and_smooth(attempt);
  else
    improve(attempt, rules_.smooth_rounds);
  std::optional<Step> step(std::in_place, "mending flat tets", merging_ends, mending_ends);
  step->expect(most_mending_rounds);
  for (int round = 0; round < most_mending_rounds && mend_flat_tets(attempt); ++round, step->advance()) {
    if (rules_.merges) make_fewer_cells(attempt, gap::Passes::merge);  // new tets let more vertices merge
    extracted = hybrid::extract(attempt.mesh, attempt.tags);
    improve(attempt, rules_.smooth_rounds);
    compute_quality(extracted.mesh);
    if (poor_cells(extracted.mesh).empty()) break;
  }
  step.reset();
  step.emplace("smoothing", mending_ends, polishing_ends);
  polish(attempt);
  step.reset();
  step.emplace("mending poor cells", polishing_ends, 1);
  if (rules_.merges) mend(attempt);
}

// What is still poor, or refused by solvers, when smoothing is over.
void Builder::mend(Attempt& attempt) const {
  hybrid::Extract& extracted = attempt.extracted;
  if (make_fewer_cells(attempt, gap::Passes::mend).any()) extracted = hybrid::extract(attempt.mesh, attempt.tags);
  const shape::SlidingSurface surface = sliding(extracted);
  if (shape::raise_worst_cells(extracted.mesh, surface) > 0) move_points(extracted, attempt.mesh);
  if (!rules_.mends_refused) return;
  bool mended = false;
  for (const gap::Passes passes : {gap::Passes::mend_refused, gap::Passes::open_for_refused})
    mended = make_fewer_cells(attempt, passes).any() || mended;
  if (mended) extracted = hybrid::extract(attempt.mesh, attempt.tags);
}

// Moves vertices; the mesh has their new places.
void Builder::improve(Attempt& attempt, int rounds) const {
  MixedMesh& mesh = attempt.extracted.mesh;
  const shape::SlidingSurface surface = sliding(attempt.extracted);
  const Step step("smoothing", 0.4, 1);
  const shape::SmoothCounts counts = shape::smooth(mesh, rounds, &surface, &attempt.settled);
  shape::untangle(mesh, untangling_rounds, &surface);
  take_over(counts, attempt);
}

// Comes when no more cells merge, flip or give way, but before single cells are mended.
void Builder::polish(Attempt& attempt) const {
  const shape::SlidingSurface surface = sliding(attempt.extracted);
  take_over(shape::polish(attempt.extracted.mesh, std::min(rules_.smooth_rounds, polishing_rounds), &surface), attempt);
}

// Mends tets for which moving vertices is not enough. False if it changes nothing.
bool Builder::mend_flat_tets(Attempt& attempt) const {
  hybrid::HybridMesh& mesh = attempt.mesh;
  const std::int64_t flips = conform::flip_poor_tets(mesh, attempt.tags, worth_a_flip);
  const std::int64_t vertices = conform::split_flat_tets(mesh, attempt.tags, worth_a_vertex);
  const std::int64_t peeled =
      conform::peel_flat_tets(mesh, attempt.tags, input_.surface, rules_.is_shared(), worth_peeling);
  attempt.improvement.flips += flips;
  attempt.improvement.vertices += vertices;
  attempt.improvement.peeled += peeled;
  return flips + vertices + peeled > 0;
}

// Candidates that are poor hexes after smoothing, and prisms that some readers would turn round.
std::vector<CandidateIndex> Builder::poor_candidates(const hybrid::HybridMesh& mesh) const {
  std::vector<CandidateIndex> result;
  for (const auto c : indices<CellIndex>(mesh.cell_count())) {
    const hybrid::HybridCell& cell = mesh.cell(c);
    if (!cell.alive || cell.candidate == no_index || rules_.is_guest(cell.candidate)) continue;
    const bool is_poor_hex = rules_.smooth_rounds > 0 && cell.kind == CellKind::hex &&
                             is_worse(mesh, cell.kind, cell.corners, shape::poor_hex);
    if (is_poor_hex || looks_inverted(mesh, cell)) result.push_back(cell.candidate);
  }
  std::ranges::sort(result);
  return result;
}

// Moving vertices leaves valid cells valid. A cell that is not valid now was not valid in the input, and nothing has
// mended it.
void Builder::check_cells_left(const hybrid::HybridMesh& mesh) const {
  for (const auto c : indices<CellIndex>(mesh.cell_count())) {
    const hybrid::HybridCell& cell = mesh.cell(c);
    if (!cell.alive || cell.candidate == no_index) continue;
    const std::span corners = std::span(cell.corners).first(corner_count(cell.kind));
    const auto at = corner_points(mesh.points, corners);
    if (!is_valid(cell.kind, std::span(at).first(corners.size())))
      throw DataError::at(names_.candidates,
                          "expected valid cells, found candidate {} whose Jacobian is not positive everywhere",
                          choice::title_of(names_, cell.candidate));
  }
}

Built Builder::finish(Attempt attempt, const GivenBackCounts& given_back) const {
  check_cells_left(attempt.mesh);
  conform::ConformityCounts& counts = attempt.conformity;
  for (std::size_t i = 0; i < conform::all_reasons.size(); ++i) counts.given_back[i] += given_back.cells[i];
  counts.volume_given_back += given_back.hex_volume;
  std::vector<CandidateIndex> left;
  append_candidates(attempt.mesh, true, left);
  std::ranges::sort(left);  // cells that got other corners come last
  return {.tags = std::move(attempt.tags),
          .extracted = std::move(attempt.extracted),
          .conformity = counts,
          .improvement = attempt.improvement,
          .before_smoothing = attempt.before_smoothing,
          .left = std::move(left)};
}

// Starts from the input again, without the given cells.
Attempt Builder::without(std::vector<CandidateIndex>& kept, const std::vector<CandidateIndex>& given_back) const {
  std::vector<CandidateIndex> rest;
  std::ranges::set_difference(kept, given_back, std::back_inserter(rest));
  kept = std::move(rest);
  hybrid::SurfaceTags tags(input_.mesh);
  hybrid::HybridMesh mesh = choice::Selection(input_.mesh, tags, candidates_, kept, names_).take_mesh();
  return {.tags = std::move(tags), .mesh = std::move(mesh)};
}

Built Builder::run(AttemptStart start) const {
  std::vector<CandidateIndex> kept = start.selection.chosen();
  std::optional<Attempt> attempt(
      Attempt{.tags = std::move(start.tags), .mesh = std::move(start.selection).take_mesh()});
  int conforming_attempts = 1, smoothing_attempts = 1;
  while (true) {
    std::vector<CandidateIndex> poor =
        conform(*attempt, conforming_attempts == most_attempts || rules_.smooth_rounds == 0);
    if (!poor.empty()) {
      ++conforming_attempts;
    } else {
      smooth_and_mend(*attempt);
      if (rules_.is_conforming && smoothing_attempts < most_attempts) poor = poor_candidates(attempt->mesh);
      if (poor.empty()) return finish(std::move(*attempt), start.given_back);
      ++smoothing_attempts;
      conforming_attempts = 1;
    }
    start.given_back.add(candidates_, poor, conform::GivenBack::poor_elements);
    attempt.reset();  // two of them would need twice the memory
    attempt.emplace(without(kept, poor));
  }
}

}  // namespace

std::span<const std::uint8_t> BuildRules::is_shared() const {
  return seam == nullptr ? std::span<const std::uint8_t>() : seam->is_shared;
}

void GivenBackCounts::add(const Candidates& candidates, const std::vector<CandidateIndex>& given_back,
                          conform::GivenBack reason) {
  cells[static_cast<std::size_t>(reason)] += static_cast<std::int64_t>(given_back.size());
  for (const CandidateIndex candidate : given_back)
    if (candidates.kind[candidate] == CellKind::hex) hex_volume += candidates.volume[candidate];
}

Built build_mesh(const AssembleInput& input, const Candidates& candidates, AttemptStart start, const BuildRules& rules,
                 const choice::InputNames& names) {
  return Builder(input, candidates, rules, names).run(std::move(start));
}

}  // namespace hexpipe::assemble
