#include "tools/assemble/pieces/part_view.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "common/run/error.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/part_bundle.hpp"

namespace hexpipe::assemble::pieces {
namespace {

std::vector<std::uint8_t> distances(const TetMesh& mesh, const MeshPart& part) {
  constexpr std::uint8_t beyond = furthest + 1;
  std::vector<std::uint8_t> distance(mesh.points.size(), beyond);
  for (std::size_t v = 0; v < distance.size(); ++v)
    if (part.point_part[v] == part.part) distance[v] = 0;
  for (std::uint8_t step = 0; step < furthest; ++step)
    for (const Tet& tet : mesh.tets) {
      if (std::ranges::none_of(tet, [&](Vertex v) { return distance[v] == step; })) continue;
      for (const Vertex v : tet) distance[v] = std::min<std::uint8_t>(distance[v], step + 1);
    }
  return distance;
}

// The settings that made a solution, without those that differ between parts.
nlohmann::ordered_json solver_of(const std::vector<nlohmann::ordered_json>& history) {
  auto all = nlohmann::ordered_json::array();
  for (const char* tool : {"findhex", "initsol", "lns", "lns-mpi"}) all.push_back(pipeline::settings_of(tool, history));
  return all;
}

class ChosenCells {
 public:
  explicit ChosenCells(PartView& view) : view_(view) {}

  // Adds the chosen candidates of a part that are its own and lie within the view. `points` and `tets` are the places
  // of its points and tets in the view; empty for the part whose numbers the view has.
  void add(const Candidates& from, const CandidateKeys& keys, const graph::IndependentSet& chosen, std::int32_t part,
           std::span<const Vertex> points, std::span<const TetIndex> tets, const std::string& source) {
    const auto bundle = static_cast<std::int32_t>(view_.bundles.size());
    view_.bundles.push_back(source);
    for (const std::int32_t i : chosen) {
      if (i < 0 || static_cast<std::size_t>(i) >= from.size())
        throw DataError::at(source, "expected candidates from 1 to {} in the solution, found {}", from.size(), i + 1);
      if (keys.part[i] != part || !is_within(from.corners_of(i), points)) continue;
      const auto tet = [&](TetIndex t) { return tets.empty() ? t : tets[t]; };
      append_candidate(
          view_.cells, from, i, [&](Vertex v) { return points.empty() ? v : points[v]; }, tet, tet);
      view_.keys.key.push_back(keys.key[i]);
      view_.keys.part.push_back(part);
      view_.origins.push_back({bundle, i});
    }
  }

  void sort() {
    std::vector<CandidateIndex> order(view_.keys.key.size());
    std::iota(order.begin(), order.end(), CandidateIndex(0));
    std::ranges::sort(order, {}, [&](CandidateIndex i) { return view_.keys.key[i]; });
    view_.cells = select(view_.cells, order);
    view_.keys = select(view_.keys, order);
    std::vector<choice::CellOrigin> origins;
    origins.reserve(order.size());
    for (const CandidateIndex i : order) origins.push_back(view_.origins[i]);
    view_.origins = std::move(origins);
  }

 private:
  bool is_within(std::span<const Vertex> corners, std::span<const Vertex> points) const {
    return std::ranges::all_of(corners, [&](Vertex v) {
      const Vertex here = points.empty() ? v : points[v];
      return here != no_index && view_.distance[here] <= furthest;
    });
  }

  PartView& view_;
};

}  // namespace

PartView view_part(SolvedPart own, const std::vector<std::string>& neighbours, const std::string& source) {
  PartView view{.part = std::move(own.part),
                .mesh = std::move(own.mesh),
                .cells = {},
                .keys = {},
                .origins = {},
                .bundles = {},
                .distance = {}};
  view.distance = distances(view.mesh, view.part);
  ChosenCells cells(view);
  cells.add(own.candidates, own.keys, own.chosen, view.part.part, {}, {}, source);
  const auto solver = solver_of(own.history);
  pipeline::for_each_neighbour(view.part, neighbours, source, [&](const pipeline::PartBundle& other) {
    if (!other.chosen) throw DataError::at(other.name, "expected a solution, found none");
    if (solver_of(other.history) != solver)
      throw DataError::at(other.name, "expected a solution made with the version and options of {}, found another",
                          source);
    const auto points = places_in(view.part.point_number, other.part.point_number);
    const auto tets = places_in<TetIndex>(view.part.tet_number, other.part.tet_number);
    cells.add(other.candidates, other.keys, *other.chosen, other.part.part, points, tets, other.name);
  });
  cells.sort();
  return view;
}

}  // namespace hexpipe::assemble::pieces
