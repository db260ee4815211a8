#include "tools/buildgraph/neighbours.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/run/error.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/part_bundle.hpp"

namespace hexpipe::buildgraph {
namespace {

// Adds to the candidates of a part other parts' candidates that may be in conflict with them.
class HaloCollector {
 public:
  HaloCollector(PartCandidates own, const MeshPart& part)
      : all_(std::move(own)),
        part_(part),
        corners_(part.point_number.size()),
        tets_(part.tet_number.size()),
        order_(all_.keys.key.size()) {
    for (const auto& row : all_.candidates.vertices)
      for (const Vertex v : row)
        if (v != no_index) corners_[v] = true;
    for (const TetIndex tet : all_.candidates.tets) tets_[tet] = true;
    std::iota(order_.begin(), order_.end(), CandidateIndex(0));
  }

  void add_from(const pipeline::PartBundle& other) {
    const std::vector<Vertex> points = places_in(part_.point_number, other.part.point_number);
    const auto tets = places_in<TetIndex>(part_.tet_number, other.part.tet_number);
    for (std::size_t i = 0; i < other.candidates.size(); ++i) {
      const bool is_own = other.keys.part[i] == other.part.part;
      if (is_own && may_conflict(other.candidates, i, points, tets)) add(other, i, points, tets);
    }
  }

  // All candidates, in the order of their keys.
  PartCandidates take() {
    std::sort(order_.begin(), order_.end(),
              [&](CandidateIndex a, CandidateIndex b) { return all_.keys.key[a] < all_.keys.key[b]; });
    return {select(all_.candidates, order_), select(all_.keys, order_)};
  }

 private:
  bool may_conflict(const Candidates& others, std::size_t i, const std::vector<Vertex>& points,
                    const std::vector<TetIndex>& tets) const {
    const auto corners = others.corners_of(i);
    const auto shared = std::count_if(corners.begin(), corners.end(),
                                      [&](Vertex v) { return points[v] != no_index && corners_[points[v]]; });
    if (shared >= 2) return true;
    const auto interior = others.interior_tets_of(i);
    return std::any_of(interior.begin(), interior.end(),
                       [&](TetIndex tet) { return tets[tet] != no_index && tets_[tets[tet]]; });
  }

  void add(const pipeline::PartBundle& other, std::size_t i, const std::vector<Vertex>& points,
           const std::vector<TetIndex>& tets) {
    const auto place = [&]<class Item>(const std::vector<Item>& places, Item item) {
      if (places[item] != no_index) return places[item];
      throw DataError::at(other.name, "expected candidates at {} to lie within its ghosts, found one beyond them",
                          title_of(part_));
    };
    const auto tet = [&](TetIndex t) { return place(tets, t); };
    append_candidate(
        all_.candidates, other.candidates, i, [&](Vertex v) { return place(points, v); }, tet, tet);
    order_.push_back(CandidateIndex(all_.keys.key.size()));
    all_.keys.key.push_back(other.keys.key[i]);
    all_.keys.part.push_back(other.part.part);
  }

  PartCandidates all_;
  const MeshPart& part_;
  std::vector<bool> corners_, tets_;  // of the part's own candidates
  std::vector<CandidateIndex> order_;
};

}  // namespace

PartCandidates with_neighbours(PartCandidates own, const MeshPart& part,
                               const std::vector<nlohmann::ordered_json>& history,
                               const std::vector<std::string>& paths, const std::string& source) {
  const nlohmann::ordered_json settings = pipeline::settings_of("findhex", history);
  HaloCollector halo(std::move(own), part);
  pipeline::for_each_neighbour(part, paths, source, [&](const pipeline::PartBundle& neighbour) {
    if (pipeline::settings_of("findhex", neighbour.history) != settings)
      throw DataError::at(neighbour.name, "expected candidates found with the version and options of {}, found others",
                          source);
    halo.add_from(neighbour);
  });
  return halo.take();
}

}  // namespace hexpipe::buildgraph
