#include "tools/assemble/assemble.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/box_tree.hpp"
#include "common/mesh/orientation.hpp"
#include "common/mesh/validity.hpp"
#include "common/run/error.hpp"
#include "common/run/progress.hpp"
#include "tools/assemble/attempt.hpp"
#include "tools/assemble/choice/exchange.hpp"
#include "tools/assemble/choice/prism_filling.hpp"
#include "tools/assemble/layers/layers.hpp"
#include "tools/assemble/self_check.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe::assemble {
namespace {

// Shares of the time that a mesh takes, for the line of progress.
constexpr double input_ends = 0.02, exchange_ends = 0.3, prisms_end = 0.38, build_ends = 0.98;

std::vector<CandidateIndex> checked_choice(const graph::IndependentSet& chosen, const Candidates& candidates,
                                           const choice::InputNames& names) {
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] < 0 || static_cast<std::size_t>(chosen[i]) >= candidates.size())
      throw DataError::at(names.solution, "expected candidates from 1 to {}, found {}", candidates.size(),
                          chosen[i] + 1);
    if (i > 0 && chosen[i] <= chosen[i - 1])
      throw DataError::at(names.solution, "expected ascending candidates, found {} after {}", chosen[i] + 1,
                          chosen[i - 1] + 1);
  }
  return {chosen.begin(), chosen.end()};
}

// The input and what tells its facets apart, all made once. The adjacency that this takes is gone afterwards: it is
// large.
struct Prepared {
  Prepared(TetMesh mesh, const TetAdjacency& adjacency)
      : input(std::move(mesh), adjacency), tags(input.mesh), boundary(input.mesh, adjacency, tags) {}

  const AssembleInput input;
  hybrid::SurfaceTags tags;              // until the first attempt takes them
  const hybrid::BoundaryQuads boundary;  // until then, too
};

Prepared checked_input(TetMesh mesh, const Candidates& candidates, const choice::InputNames& names) {
  const Step step("checking the input", 0, input_ends);
  validate_against(candidates, mesh, names.candidates.c_str());
  check_orientation(mesh, names);
  const TetAdjacency adjacency(mesh, names.mesh.c_str());
  check_sides(mesh, adjacency, names.mesh.c_str());
  hybrid::complete_surface(mesh, adjacency);
  return Prepared(std::move(mesh), adjacency);
}

// Whether a quad of the candidate has three or four of its halves, along both diagonals, among the tagged triangles:
// its four vertices span a slit or a hole, or an interface around a tet. On the far side nothing can tell the quad from
// the triangles along its other diagonal, or from the one that is there.
bool closes_a_hole(const hybrid::SurfaceTags& tags, const Candidates& candidates, CandidateIndex candidate) {
  hybrid::HybridCell cell;
  cell.kind = candidates.kind[candidate];
  cell.corners = candidates.vertices[candidate];
  for (int i = 0; i < cell.quad_count(); ++i) {
    if (!tags.is_on_surface(cell.quad(i))) continue;
    int tagged = 0;
    for (int diagonal = 0; diagonal < 2; ++diagonal)
      for (const auto& half : triangles_of(cell.quad(i), diagonal)) tagged += tags.contains(half);
    if (tagged >= 3) return true;
  }
  return false;
}

// Cells that fit together and close no hole, and the count of those that did.
struct Cells {
  choice::Selection selection;
  GivenBackCounts given_back;
};

// The chosen cells without those at holes, which are counted.
std::vector<CandidateIndex> without_those_at_holes(const hybrid::SurfaceTags& tags, const Candidates& candidates,
                                                   const std::vector<CandidateIndex>& chosen,
                                                   GivenBackCounts& given_back) {
  std::vector<CandidateIndex> at_holes, rest;
  std::ranges::partition_copy(chosen, std::back_inserter(at_holes), std::back_inserter(rest),
                              [&](CandidateIndex c) { return closes_a_hole(tags, candidates, c); });
  given_back.add(candidates, at_holes, conform::GivenBack::diagonal_on_surface);
  return rest;
}

Cells cells_of(const Prepared& at, const Candidates& candidates, const std::vector<CandidateIndex>& chosen,
               const choice::InputNames& names) {
  GivenBackCounts given_back;
  std::vector<CandidateIndex> rest = without_those_at_holes(at.tags, candidates, chosen, given_back);
  return {choice::Selection(at.input.mesh, at.tags, candidates, std::move(rest), names), given_back};
}

// As above; what is selected stays where no cell is at a hole, as nearly always.
Cells cells_of(const Prepared& at, const Candidates& candidates, choice::Selection selection,
               const choice::InputNames& names) {
  GivenBackCounts given_back;
  std::vector<CandidateIndex> rest = without_those_at_holes(at.tags, candidates, selection.chosen(), given_back);
  if (rest != selection.chosen())
    selection = choice::Selection(at.input.mesh, at.tags, candidates, std::move(rest), names);
  return {std::move(selection), given_back};
}

// The tets of a piece, without the guests'.
TetMesh own_tets(TetMesh mesh, const hybrid::Seam& seam) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.tet_tags[t] == seam.guest_region) continue;
    mesh.tets[kept] = mesh.tets[t];
    mesh.tet_tags[kept++] = mesh.tet_tags[t];
  }
  mesh.tets.resize(kept);
  mesh.tet_tags.resize(kept);
  return mesh;
}

// Checks what is built, and without guests and seam makes it the result.
hybrid::Extract checked_extract(const AssembleInput& input, Built& built, const BuildRules& rules,
                                CheckedVolumes& volumes) {
  if (rules.seam == nullptr) {
    volumes = check_result(built.extracted, input.mesh, built.tags, input.surface, rules.is_conforming);
    return std::move(built.extracted);
  }
  hybrid::Extract own = hybrid::without_guests(built.extracted, *rules.seam);
  volumes = check_result(own, own_tets(input.mesh, *rules.seam), built.tags, input.surface, rules.is_conforming);
  return hybrid::without_seam_facets(std::move(own), *rules.seam);
}

AssembleResult result_of(Prepared& at, const Candidates& candidates, Cells cells, const BuildRules& rules,
                         const choice::InputNames& names) {
  std::optional<Step> step(std::in_place, "building the mesh", prisms_end, build_ends);
  Built built = build_mesh(at.input, candidates, {std::move(at.tags), std::move(cells.selection), cells.given_back},
                           rules, names);
  step.reset();
  step.emplace("checking the result", build_ends, 1);
  AssembleStatistics statistics;
  hybrid::Extract extracted = checked_extract(at.input, built, rules, statistics.volumes);
  count_cells(extracted.mesh, statistics);
  if (rules.seam == nullptr) statistics.measures = measure_mesh(extracted.mesh);
  statistics.conformity = built.conformity;
  statistics.improvement = built.improvement;
  statistics.before_smoothing = built.before_smoothing;
  return {std::move(extracted.mesh), std::move(statistics), std::move(extracted.origin), std::move(built.left)};
}

struct SelectedCells {
  choice::Selection selection;
  std::optional<choice::ExchangeCounts> exchange;
};

// The mesh of a selection is large, and the search does not need it: only the choice comes in.
SelectedCells exchanged(const Prepared& at, const Candidates& candidates, const choice::CheckedChoice& choice,
                        const choice::InputNames& names) {
  const auto select = [&](std::vector<CandidateIndex> chosen) {
    return choice::Selection(at.input.mesh, at.tags, candidates, std::move(chosen), names);
  };
  choice::Exchange exchange = choice::exchange_hexes(at.input.mesh, at.boundary, candidates, choice);
  try {
    return {select(std::move(exchange.chosen)), exchange.counts};
  } catch (const DataError&) {
    // Candidates of another program may lack slivers on their quads, so that two of them overlap.
    const std::int64_t open = exchange.counts.open_quads_before;
    return {select(choice.chosen()), choice::ExchangeCounts{.open_quads_before = open, .open_quads_after = open}};
  }
}

// The chosen cells, or others in exchange.
SelectedCells selected(const Prepared& at, const Candidates& candidates, const std::vector<CandidateIndex>& chosen,
                       bool exchanges, const choice::InputNames& names) {
  if (!exchanges) return {choice::Selection(at.input.mesh, at.tags, candidates, chosen, names), std::nullopt};
  const Step step("exchanging hexes", input_ends, exchange_ends);
  const choice::CheckedChoice choice =
      choice::Selection(at.input.mesh, at.tags, candidates, chosen, names).take_choice();
  return exchanged(at, candidates, choice, names);
}

// The result has prisms between the selected cells.
AssembleResult filled_result_of(Prepared& at, const Candidates& candidates, std::optional<choice::Selection> selection,
                                const BuildRules& rules, const choice::InputNames& names) {
  std::optional<Step> step(std::in_place, "making prisms of tets", exchange_ends, prisms_end);
  const choice::PrismFilling filling = choice::fill_with_prisms(at.input.mesh, at.boundary, candidates, *selection);
  choice::InputNames names_of_cells = names;
  for (const CandidateIndex candidate : selection->chosen()) names_of_cells.origins.push_back({0, candidate});
  // Prisms have no number that a user could know: their numbers follow those of the candidates.
  const auto first = static_cast<std::int32_t>(candidates.size());
  for (std::int32_t i = 0; i < filling.prisms; ++i) names_of_cells.origins.push_back({0, first + i});
  selection.reset();
  step.reset();
  Cells cells = cells_of(at, filling.cells, choice::all_of(filling.cells), names_of_cells);
  AssembleResult result = result_of(at, filling.cells, std::move(cells), rules, names_of_cells);
  result.statistics.filling_prisms = filling.prisms;
  return result;
}

AssembleResult without_layers(Prepared& at, const Candidates& candidates, const std::vector<CandidateIndex>& chosen,
                              const AssembleOptions& options, const choice::InputNames& names) {
  const BuildRules rules = build_rules(options);
  const bool exchanges = rules.is_conforming && options.exchange == AssembleOptions::Exchange::quads;
  const bool fills = rules.is_conforming && options.fill == AssembleOptions::Fill::prisms;
  if (!exchanges && !fills) return result_of(at, candidates, cells_of(at, candidates, chosen, names), rules, names);

  auto [selection, exchange] = selected(at, candidates, chosen, exchanges, names);
  AssembleResult result =
      fills ? filled_result_of(at, candidates, std::move(selection), rules, names)
            : result_of(at, candidates, cells_of(at, candidates, std::move(selection), names), rules, names);
  result.statistics.exchange = exchange;
  return result;
}

// The layers that the options ask for: first the pillow, then those of the walls, which then lie on the boundary.
struct AskedLayers {
  std::optional<layers::LayerRules> pillow, walls;

  AskedLayers(const TetMesh& mesh, const LayerOptions& options, const choice::InputNames& names) {
    const auto find = [&](std::span<const layers::AskedWall> asked) {
      return layers::find_walls(asked, mesh, options.tag_names, names.mesh);
    };
    if (!options.walls.empty()) check_height(mesh, options.first_height, names);
    if (!options.walls.empty())
      walls = layers::LayerRules{
          .walls = find(options.walls), .first_height = options.first_height, .growth = options.growth};
    if (options.pillow) pillow = layers::LayerRules{.walls = find(std::array{layers::AskedWall{"all", 1}})};
  }
  bool any() const { return pillow || walls; }

 private:
  static void check_height(const TetMesh& mesh, double height, const choice::InputNames& names) {
    const double least = layers::least_height * Box::around(mesh.points).diagonal();
    if (height < least)
      throw DataError::at(names.mesh,
                          "--first-height: expected at least {:.3g}, {:g} of the diagonal of the mesh, found {:g}",
                          least, layers::least_height, height);
  }
};

void add_layers(const AskedLayers& asked, const AssembleInput& input, int smooth_rounds, AssembleResult& result) {
  const BeforeLayers before{region_volumes(result.mesh), result.statistics.volumes.deviation};
  const auto add = [&](const layers::LayerRules& rules) {
    return layers::add_layers(result.mesh, result.origin, input.mesh, input.surface, rules);
  };
  AssembleStatistics& statistics = result.statistics;
  if (asked.pillow) {
    statistics.pillow = add(*asked.pillow);
    const shape::SlidingSurface sliding{input.surface, input.mesh.points, result.origin};
    shape::smooth(result.mesh, smooth_rounds, &sliding);
    layers::judge_cells(result.mesh, *statistics.pillow);
  }
  if (asked.walls) statistics.layers = add(*asked.walls);
  double& deviation = statistics.volumes.deviation;
  deviation = std::max(deviation, check_layered(result.mesh, result.origin, input.mesh, input.surface, before));
  count_cells(result.mesh, statistics);
  statistics.measures = measure_mesh(result.mesh);
}

}  // namespace

void check_orientation(const TetMesh& mesh, const choice::InputNames& names) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    if (orientation(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) <= 0)
      throw DataError::at(names.mesh, "expected positively oriented tets, found tet {} flat or inverted", t + 1);
  }
}

BuildRules build_rules(const AssembleOptions& options) {
  const bool is_conforming = options.conformity == AssembleOptions::Conformity::pyramids;
  const bool merges = is_conforming && options.smooth > 0 && options.merge == AssembleOptions::Merge::vertices;
  return {.is_conforming = is_conforming,
          .smooth_rounds = options.smooth,
          .merges = merges,
          .mends_refused = merges && options.mend == AssembleOptions::Mend::finite_volumes};
}

AssembleResult assemble(TetMesh mesh, const Candidates& candidates, const graph::IndependentSet& solution,
                        const AssembleOptions& options, const choice::InputNames& names, const LayerOptions& layers) {
  const std::vector<CandidateIndex> chosen = checked_choice(solution, candidates, names);
  Prepared at = checked_input(std::move(mesh), candidates, names);
  const AskedLayers asked(at.input.mesh, layers, names);
  AssembleResult result = without_layers(at, candidates, chosen, options, names);
  if (asked.any()) add_layers(asked, at.input, options.smooth, result);
  return result;
}

AssembleResult assemble_piece(TetMesh mesh, const Candidates& cells, const BuildRules& rules,
                              const choice::InputNames& names) {
  Prepared at = checked_input(std::move(mesh), cells, names);
  return result_of(at, cells, cells_of(at, cells, choice::all_of(cells), names), rules, names);
}

}  // namespace hexpipe::assemble
