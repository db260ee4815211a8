#include "tools/assemble/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/face_view.hpp"
#include "common/mesh/orientation.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/run/error.hpp"
#include "tools/assemble/choice/exchange.hpp"
#include "tools/assemble/choice/fill.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/conform/conform.hpp"
#include "tools/assemble/conform/peel.hpp"
#include "tools/assemble/conform/reconnect.hpp"
#include "tools/assemble/conform/repair.hpp"
#include "tools/assemble/gap/fewer_cells.hpp"
#include "tools/assemble/hybrid/boundary_quads.hpp"
#include "tools/assemble/hybrid/complete_surface.hpp"
#include "tools/assemble/hybrid/extract.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/self_check.hpp"
#include "tools/assemble/shape/input_surface.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe::assemble {
namespace {

void check_chosen(const graph::IndependentSet& chosen, const Candidates& candidates, const choice::InputNames& names) {
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] < 0 || static_cast<std::size_t>(chosen[i]) >= candidates.size())
      throw DataError::at(names.solution, "expected candidates from 1 to {}, found {}", candidates.size(),
                          chosen[i] + 1);
    if (i > 0 && chosen[i] <= chosen[i - 1])
      throw DataError::at(names.solution, "expected ascending candidates, found {} after {}", chosen[i] + 1,
                          chosen[i - 1] + 1);
  }
}

// New elements may be this inverted before smoothing: beyond it untangling has been seen to fail.
constexpr double most_inverted = -0.3;
// Without smoothing, new elements only have to be valid, with room for rounding.
constexpr double barely_valid = 1e-4;
constexpr int untangling_rounds = 20;
// Rounds of conforming, untangling and giving back what stays poor. Two nearly always do; the last one takes no risks.
constexpr int most_attempts = 4;
// Rounds of merging vertices, each with smoothing behind it: a fourth finds a tenth of what the third does.
constexpr int most_merges = 3;
// Two leave as many cells as five, and as good ones, for a seventh less time.
constexpr int rounds_between_merges = 2;
// Rounds of what does more than moving vertices.
constexpr int most_repairs = 4;
// Tets that smoothing leaves below the first are exchanged for others on the same vertices; those that this leaves
// below the second get a vertex beside them.
constexpr double worth_an_exchange = 0.15;
constexpr double worth_a_vertex = 0.05;
// Below this they are taken off where they lie on the boundary.
constexpr double worth_peeling = 0.1;

void move_points(const hybrid::Extract& from, hybrid::HybridMesh& to) {
  for (std::size_t i = 0; i < from.origin.size(); ++i) to.points[from.origin[i]] = from.mesh.points[i];
}

bool is_worse(const hybrid::HybridMesh& mesh, CellKind kind, std::span<const Vertex> corners, double limit) {
  const auto at = corner_points(mesh.points, corners);
  const double scale = kind == CellKind::tet ? std::sqrt(2.0) : 1;
  return scale * least_corner_scaled_jacobian(kind, std::span<const Vec3>(at).first(corners.size())) < limit;
}

// Whether a reader that judges by averages of vertices takes the prism for inverted, though it is valid. Pyramids over
// warped bases often look so, but no reader is known that turns them; hexes this warped are poor.
bool looks_inverted(const hybrid::HybridMesh& mesh, const hybrid::HybridCell& cell) {
  if (cell.kind != CellKind::prism) return false;
  const auto at = corner_points(mesh.points, std::span(cell.corners).first(6));
  return least_face_view(cell.kind, std::span<const Vec3>(at).first(6)) <= 0;
}

// Whether a quad of the candidate has tagged triangles along both diagonals: it stands at a hole, or an interface
// around a tet, that its four vertices span. On the far side nothing can tell the quad from these two triangles.
bool closes_a_hole(const hybrid::SurfaceTags& tags, const Candidates& candidates, std::int32_t candidate) {
  hybrid::HybridCell cell;
  cell.kind = candidates.kind[candidate];
  cell.corners = candidates.vertices[candidate];
  for (int i = 0; i < cell.quad_count(); ++i) {
    int tagged = 0;
    for (int diagonal = 0; diagonal < 2; ++diagonal)
      for (const auto& half : triangles_of(cell.quad(i), diagonal)) tagged += tags.contains(half);
    if (tagged == 4) return true;
  }
  return false;
}

// Candidates whose cells went back to their tets.
void append_given_back(const hybrid::HybridMesh& mesh, std::vector<std::int32_t>& out) {
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(mesh.cell_count()); ++c)
    if (!mesh.cell(c).alive && mesh.cell(c).candidate != hybrid::HybridCell::none)
      out.push_back(mesh.cell(c).candidate);
}

// The candidates to which poor pyramids and tets made for conformity belong. An inverted tet at a vertex without a
// pyramid was made for a cell that has gone back since: then all of these, so that they are left out from the start.
std::vector<std::int32_t> owners_of_poor_elements(const hybrid::HybridMesh& mesh, std::size_t input_points) {
  std::vector<std::int32_t> owners;
  std::vector<std::int32_t> owner_of_point(mesh.points.size(), hybrid::HybridCell::none);
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(mesh.cell_count()); ++c) {
    const hybrid::HybridCell& cell = mesh.cell(c);
    if (!cell.alive || cell.candidate != hybrid::HybridCell::none) continue;
    const std::int32_t owner = mesh.cell(mesh.partner_at(cell.quad(0), c)).candidate;
    owner_of_point[cell.corners[4]] = owner;
    if (is_worse(mesh, cell.kind, std::span(cell.corners).first(5), shape::poor_quality)) owners.push_back(owner);
  }
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.tet_count()); ++t) {
    if (!mesh.is_alive(t)) continue;
    // The vertex added last made the tet.
    const Vertex newest = *std::ranges::max_element(mesh.tet(t));
    if (static_cast<std::size_t>(newest) < input_points) continue;
    const bool has_owner = owner_of_point[newest] != hybrid::HybridCell::none;
    if (!is_worse(mesh, CellKind::tet, mesh.tet(t), has_owner ? shape::poor_quality : barely_valid)) continue;
    if (has_owner)
      owners.push_back(owner_of_point[newest]);
    else
      append_given_back(mesh, owners);
  }
  std::sort(owners.begin(), owners.end());
  owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
  return owners;
}

class Assembler {
 public:
  // `input` with its surface complete, and its adjacency; `seam` where it is a piece of a mesh, else null.
  Assembler(TetMesh input, const TetAdjacency& adjacency, const Candidates& candidates,
            const graph::IndependentSet& chosen, const AssembleOptions& options, const choice::InputNames& names,
            const hybrid::Seam* seam)
      : input_(std::move(input)),
        tags_(input_),
        surface_(input_, adjacency),
        candidates_(candidates),
        kept_(chosen),
        options_(options),
        names_(names),
        seam_(seam) {
    if (seam != nullptr) is_shared_ = seam->is_shared;
  }

  AssembleResult run();

 private:
  bool is_conforming() const { return options_.conformity == AssembleOptions::Conformity::pyramids; }
  bool merges() const { return is_conforming() && options_.merge == AssembleOptions::Merge::vertices; }
  bool is_guest(std::int32_t candidate) const { return seam_ != nullptr && seam_->is_guest[candidate] != 0; }
  hybrid::Extract own_part_of(hybrid::Extract extracted) const;
  TetMesh own_input() const;
  hybrid::Extract build();
  hybrid::HybridMesh select();
  hybrid::HybridMesh conform();
  std::vector<std::int32_t> poor_candidates(const hybrid::HybridMesh& hybrid) const;
  void untangle_in_place(hybrid::HybridMesh& hybrid) const;
  void give_back(const std::vector<std::int32_t>& owners, conform::GivenBack reason);
  hybrid::Extract merge_and_smooth(hybrid::HybridMesh& hybrid);
  hybrid::Extract smooth_and_repair(hybrid::HybridMesh& hybrid);
  void improve(hybrid::Extract& extracted, int rounds);
  void note_cells_left(const hybrid::HybridMesh& hybrid);
  void check_cells_left(const hybrid::HybridMesh& hybrid) const;

  const TetMesh input_;
  hybrid::SurfaceTags tags_;
  shape::InputSurface surface_;
  const Candidates& candidates_;
  graph::IndependentSet kept_;
  const AssembleOptions& options_;
  const choice::InputNames& names_;
  const hybrid::Seam* seam_;
  std::span<const std::uint8_t> is_shared_;  // by vertex of the input; empty without a seam
  AssembleStatistics statistics_;
  // Cells that went back between attempts, and the volume of the hexes among them.
  std::array<std::int64_t, conform::all_reasons.size()> given_back_{};
  double volume_given_back_ = 0;
  graph::IndependentSet left_;  // candidates that are cells of the result
};

hybrid::HybridMesh Assembler::select() {
  tags_ = hybrid::SurfaceTags(input_);
  return choice::build_selection(input_, tags_, candidates_, kept_, names_);
}

// Conforms with inverted elements where there is no better, untangles them, and starts anew without the cells for which
// that does not succeed.
hybrid::HybridMesh Assembler::conform() {
  for (int attempt = 1;; ++attempt) {
    const bool last = attempt == most_attempts || options_.smooth == 0;
    hybrid::HybridMesh hybrid = select();
    statistics_.conformity = conform::make_conforming(hybrid, tags_, candidates_, last ? barely_valid : most_inverted);
    if (last) return hybrid;
    untangle_in_place(hybrid);
    if (!owners_of_poor_elements(hybrid, input_.points.size()).empty() &&
        conform::reconnect_poor_tets(hybrid, tags_, worth_a_vertex) > 0)
      untangle_in_place(hybrid);
    const auto owners = owners_of_poor_elements(hybrid, input_.points.size());
    if (owners.empty()) return hybrid;
    give_back(owners, conform::GivenBack::poor_elements);
  }
}

void Assembler::untangle_in_place(hybrid::HybridMesh& hybrid) const {
  hybrid::Extract extracted = hybrid::extract(hybrid, tags_);
  const shape::SlidingSurface sliding{surface_, input_.points, extracted.origin, is_shared_};
  shape::untangle(extracted.mesh, untangling_rounds, &sliding);
  move_points(extracted, hybrid);
}

void Assembler::give_back(const std::vector<std::int32_t>& owners, conform::GivenBack reason) {
  graph::IndependentSet rest;
  std::ranges::set_difference(kept_, owners, std::back_inserter(rest));
  kept_ = std::move(rest);
  given_back_[static_cast<std::size_t>(reason)] += static_cast<std::int64_t>(owners.size());
  for (std::int32_t owner : owners)
    if (candidates_.kind[owner] == CellKind::hex) volume_given_back_ += candidates_.volume[owner];
}

// Fewer cells first, quickly, so that less is smoothed; then once more where vertices stand well.
hybrid::Extract Assembler::merge_and_smooth(hybrid::HybridMesh& hybrid) {
  hybrid::Extract extracted;
  for (int pass = 0; pass < most_merges; ++pass) {
    const auto fewer = gap::make_fewer_cells(hybrid, {tags_, surface_}, is_shared_,
                                             pass == 0 ? gap::Effort::quick : gap::Effort::full);
    statistics_.fewer += fewer;
    if (pass > 0 && !fewer.any()) break;
    extracted = extract(hybrid, tags_);
    improve(extracted, pass == 0 ? options_.smooth : std::min(options_.smooth, rounds_between_merges));
    move_points(extracted, hybrid);
  }
  return extracted;
}

// Moves vertices, then exchanges tets and adds vertices where that was not enough; again while poor cells are left.
hybrid::Extract Assembler::smooth_and_repair(hybrid::HybridMesh& hybrid) {
  hybrid::Extract extracted = hybrid::extract(hybrid, tags_);
  if (options_.smooth == 0) return extracted;
  compute_quality(extracted.mesh);
  statistics_.before_smoothing = kind_statistics(seam_ == nullptr ? extracted.mesh : own_part_of(extracted).mesh);
  if (merges())
    extracted = merge_and_smooth(hybrid);
  else
    improve(extracted, options_.smooth);
  for (int pass = 0; pass < most_repairs; ++pass) {
    move_points(extracted, hybrid);
    const std::int64_t exchanges = conform::reconnect_poor_tets(hybrid, tags_, worth_an_exchange);
    const std::int64_t repaired = conform::repair_flat_tets(hybrid, tags_, worth_a_vertex);
    const std::int64_t peeled = conform::peel_flat_tets(hybrid, tags_, surface_, is_shared_, worth_peeling);
    if (exchanges + repaired + peeled == 0) break;
    // New tets let more vertices merge.
    if (merges()) statistics_.fewer += gap::make_fewer_cells(hybrid, {tags_, surface_}, is_shared_, gap::Effort::quick);
    statistics_.exchanges += exchanges;
    statistics_.repaired += repaired;
    statistics_.peeled += peeled;
    extracted = hybrid::extract(hybrid, tags_);
    improve(extracted, options_.smooth);
    compute_quality(extracted.mesh);
    if (poor_cells(extracted.mesh).empty()) break;
  }
  if (!merges()) return extracted;
  move_points(extracted, hybrid);
  statistics_.fewer += gap::make_fewer_cells(hybrid, {tags_, surface_}, is_shared_, gap::Effort::last);
  return hybrid::extract(hybrid, tags_);
}

void Assembler::improve(hybrid::Extract& extracted, int rounds) {
  const shape::SlidingSurface sliding{surface_, input_.points, extracted.origin, is_shared_};
  const shape::SmoothCounts counts = shape::smooth(extracted.mesh, rounds, &sliding);
  statistics_.smoothing.rounds += counts.rounds;
  statistics_.smoothing.moves += counts.moves;
  shape::untangle(extracted.mesh, untangling_rounds, &sliding);
}

// Candidates that are poor hexes after all, and prisms that readers would turn round.
std::vector<std::int32_t> Assembler::poor_candidates(const hybrid::HybridMesh& hybrid) const {
  std::vector<std::int32_t> result;
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(hybrid.cell_count()); ++c) {
    const hybrid::HybridCell& cell = hybrid.cell(c);
    if (!cell.alive || cell.candidate == hybrid::HybridCell::none || is_guest(cell.candidate)) continue;
    const bool is_poor_hex =
        cell.kind == CellKind::hex && options_.smooth > 0 && is_worse(hybrid, cell.kind, cell.corners, shape::poor_hex);
    if (is_poor_hex || looks_inverted(hybrid, cell)) result.push_back(cell.candidate);
  }
  std::sort(result.begin(), result.end());
  return result;
}

void Assembler::note_cells_left(const hybrid::HybridMesh& hybrid) {
  left_.clear();
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(hybrid.cell_count()); ++c)
    if (hybrid.cell(c).alive && hybrid.cell(c).candidate != hybrid::HybridCell::none)
      left_.push_back(hybrid.cell(c).candidate);
}

// Moving vertices leaves valid cells valid: one that is not has come so, and no other mend was found.
void Assembler::check_cells_left(const hybrid::HybridMesh& hybrid) const {
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(hybrid.cell_count()); ++c) {
    const hybrid::HybridCell& cell = hybrid.cell(c);
    if (!cell.alive || cell.candidate == hybrid::HybridCell::none) continue;
    const std::span corners = std::span(cell.corners).first(corner_count(cell.kind));
    const auto at = corner_points(hybrid.points, corners);
    if (!is_valid(cell.kind, std::span(at).first(corners.size())))
      throw DataError::at(names_.candidates,
                          "expected valid cells, found candidate {} whose Jacobian is not positive everywhere",
                          choice::title_of(names_, cell.candidate));
  }
}

// Without what is the guests'.
hybrid::Extract Assembler::own_part_of(hybrid::Extract extracted) const {
  if (seam_ == nullptr) return extracted;
  return hybrid::without(extracted, seam_->guest_region, seam_->guest_tag);
}

// The input without the guests' tets; of a piece only.
TetMesh Assembler::own_input() const {
  TetMesh own = input_;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < own.tets.size(); ++t) {
    if (own.tet_tags[t] == seam_->guest_region) continue;
    own.tets[kept] = own.tets[t];
    own.tet_tags[kept++] = own.tet_tags[t];
  }
  own.tets.resize(kept);
  own.tet_tags.resize(kept);
  return own;
}

// All of it, anew without the hexes that stay poor and the prisms that look inverted.
hybrid::Extract Assembler::build() {
  for (int attempt = 1;; ++attempt) {
    statistics_.smoothing = {};
    statistics_.exchanges = statistics_.repaired = statistics_.peeled = 0;
    statistics_.fewer = {};
    hybrid::HybridMesh hybrid = is_conforming() ? conform() : select();
    hybrid::Extract extracted = smooth_and_repair(hybrid);
    move_points(extracted, hybrid);
    note_cells_left(hybrid);
    const auto poor = poor_candidates(hybrid);
    if (!is_conforming() || poor.empty() || attempt == most_attempts) {
      check_cells_left(hybrid);
      return extracted;
    }
    give_back(poor, conform::GivenBack::poor_elements);
  }
}

AssembleResult Assembler::run() {
  std::vector<std::int32_t> at_holes;
  std::ranges::copy_if(kept_, std::back_inserter(at_holes),
                       [&](std::int32_t c) { return closes_a_hole(tags_, candidates_, c); });
  give_back(at_holes, conform::GivenBack::diagonal_on_surface);
  hybrid::Extract extracted = own_part_of(build());
  for (std::size_t i = 0; i < given_back_.size(); ++i) statistics_.conformity.given_back[i] += given_back_[i];
  statistics_.conformity.volume_given_back += volume_given_back_;
  statistics_.volumes =
      check_result(extracted, seam_ == nullptr ? input_ : own_input(), tags_, surface_, is_conforming());
  if (seam_ != nullptr) extracted = hybrid::without_facets(std::move(extracted), seam_->seam_tag);
  compute_quality(extracted.mesh);
  statistics_.kinds = kind_statistics(extracted.mesh);
  const auto inside = least_inside(extracted.mesh);
  for (std::size_t i = 0; i < inside.size(); ++i) statistics_.kinds[i].least_inside = inside[i];
  statistics_.poor = poor_cells(extracted.mesh);
  statistics_.points = static_cast<std::int64_t>(extracted.mesh.points.size());
  statistics_.triangles = static_cast<std::int64_t>(extracted.mesh.triangles.size());
  statistics_.quads = static_cast<std::int64_t>(extracted.mesh.quads.size());
  return {std::move(extracted.mesh), statistics_, std::move(extracted.origin), std::move(left_)};
}

}  // namespace

void check_orientation(const TetMesh& mesh, const choice::InputNames& names) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    if (orientation(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) <= 0)
      throw DataError::at(names.mesh, "expected positively oriented tets, found tet {} flat or inverted", t + 1);
  }
}

namespace {

// The cells as they are. `adjacency` takes much memory: it is gone when it has done its work.
AssembleResult assemble_cells(TetMesh mesh, std::optional<TetAdjacency>& adjacency, const Candidates& cells,
                              const graph::IndependentSet& chosen, const AssembleOptions& options,
                              const choice::InputNames& names, const hybrid::Seam* seam) {
  Assembler assembler(std::move(mesh), *adjacency, cells, chosen, options, names, seam);
  adjacency.reset();
  return assembler.run();
}

// Throws what is wrong with the choice as it came.
choice::Exchange exchanged(const TetMesh& mesh, const TetAdjacency& adjacency, const Candidates& candidates,
                           const graph::IndependentSet& chosen, const choice::InputNames& names) {
  const hybrid::SurfaceTags tags(mesh);
  choice::build_selection(mesh, tags, candidates, chosen, names);
  choice::Exchange exchange =
      choice::exchange_hexes(mesh, hybrid::BoundaryQuads(mesh, adjacency, tags), candidates, chosen);
  try {
    choice::build_selection(mesh, tags, candidates, exchange.chosen, names);
  } catch (const DataError&) {
    // Candidates of another program may lack slivers on their quads, by which two of them overlap.
    const std::int64_t open = exchange.counts.open_quads_before;
    return {chosen, {.open_quads_before = open, .open_quads_after = open}};
  }
  return exchange;
}

// With prisms between the chosen cells.
AssembleResult assemble_filled(TetMesh mesh, std::optional<TetAdjacency>& adjacency, const Candidates& candidates,
                               const graph::IndependentSet& chosen, const AssembleOptions& options,
                               const choice::InputNames& names) {
  Candidates cells = select(candidates, chosen);
  std::int64_t prisms = 0;
  {
    const hybrid::SurfaceTags tags(mesh);
    const hybrid::BoundaryQuads boundary(mesh, *adjacency, tags);
    prisms = choice::append_filling_prisms(mesh, boundary,
                                           choice::build_selection(mesh, tags, candidates, chosen, names), cells);
  }
  choice::InputNames names_of_cells = names;
  for (const std::int32_t candidate : chosen) names_of_cells.origins.push_back({0, candidate});
  // Prisms have no number that a user could know: they come behind all candidates.
  for (std::int64_t i = 0; i < prisms; ++i)
    names_of_cells.origins.push_back({0, static_cast<std::int32_t>(static_cast<std::int64_t>(candidates.size()) + i)});
  graph::IndependentSet all(cells.size());
  std::iota(all.begin(), all.end(), 0);
  AssembleResult result = assemble_cells(std::move(mesh), adjacency, cells, all, options, names_of_cells, nullptr);
  result.statistics.filling_prisms = prisms;
  return result;
}

}  // namespace

AssembleResult assemble(TetMesh mesh, const Candidates& candidates, const graph::IndependentSet& chosen,
                        const AssembleOptions& options, const choice::InputNames& names, const hybrid::Seam* seam) {
  validate_against(candidates, mesh, names.candidates.c_str());
  check_chosen(chosen, candidates, names);
  check_orientation(mesh, names);
  std::optional<TetAdjacency> adjacency(std::in_place, mesh, names.mesh.c_str());
  check_sides(mesh, *adjacency, names.mesh.c_str());
  if (seam != nullptr) return assemble_cells(std::move(mesh), adjacency, candidates, chosen, options, names, seam);
  hybrid::complete_surface(mesh, *adjacency);
  if (options.conformity != AssembleOptions::Conformity::pyramids)
    return assemble_cells(std::move(mesh), adjacency, candidates, chosen, options, names, nullptr);
  std::optional<choice::Exchange> exchange;
  if (options.exchange == AssembleOptions::Exchange::quads)
    exchange = exchanged(mesh, *adjacency, candidates, chosen, names);
  const graph::IndependentSet& cells = exchange ? exchange->chosen : chosen;
  AssembleResult result = options.fill == AssembleOptions::Fill::prisms
                              ? assemble_filled(std::move(mesh), adjacency, candidates, cells, options, names)
                              : assemble_cells(std::move(mesh), adjacency, candidates, cells, options, names, nullptr);
  if (exchange) result.statistics.exchange = exchange->counts;
  return result;
}

}  // namespace hexpipe::assemble
