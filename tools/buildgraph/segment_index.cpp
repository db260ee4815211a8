#include "tools/buildgraph/segment_index.hpp"

#include <algorithm>
#include <numeric>

#include "common/run/parallel.hpp"

namespace hexpipe {
namespace {

constexpr std::int64_t vertices_a_block = 256;

// visit(pair, lower vertex, higher vertex, whether they are an edge)
template <class Visit>
void for_each_pair(const Candidates& candidates, std::size_t i, Visit&& visit) {
  with_topology(candidates.kind[i], [&]<class Topology>(Topology) {
    for (std::size_t pair = 0; pair < corner_pairs<Topology>.size(); ++pair) {
      const CornerPair& corners = corner_pairs<Topology>[pair];
      const auto [low, high] = std::minmax(candidates.vertices[i][corners.a], candidates.vertices[i][corners.b]);
      visit(pair, low, high, corners.is_edge);
    }
  });
}

CornerPair corners_of(CellKind kind, std::size_t pair) {
  return with_topology(kind, [&]<class Topology>(Topology) { return corner_pairs<Topology>[pair]; });
}

std::size_t most_pairs(const Candidates& candidates) {
  std::size_t most = 0;
  for (const CellKind kind : {CellKind::pyramid, CellKind::prism, CellKind::hex})
    if (std::find(candidates.kind.begin(), candidates.kind.end(), kind) != candidates.kind.end())
      most = with_topology(kind, []<class Topology>(Topology) { return corner_pairs<Topology>.size(); });
  return most;
}

// The segments at one lower vertex after another: numbers them by their higher vertex as they come.
class SegmentMaker {
 public:
  explicit SegmentMaker(std::size_t vertex_count) : number_of_(vertex_count, none) {}

  std::int32_t number(Vertex high) {
    if (number_of_[high] == none) {
      number_of_[high] = static_cast<std::int32_t>(segments_.size());
      segments_.push_back({high, {0, 0}, 0});
    }
    return number_of_[high];
  }

  struct Segment {
    Vertex high;
    std::array<std::int32_t, 2> counts;  // as an edge, otherwise
    std::uint32_t begin;
  };
  std::vector<Segment>& segments() { return segments_; }

  void clear() {
    for (const Segment& segment : segments_) number_of_[segment.high] = none;
    segments_.clear();
  }

 private:
  static constexpr std::int32_t none = -1;
  std::vector<std::int32_t> number_of_;  // by higher vertex
  std::vector<Segment> segments_;
};

constexpr std::size_t header = 2;

}  // namespace

SegmentIndex::SegmentIndex(const Candidates& candidates, std::size_t vertex_count)
    : stride_(most_pairs(candidates)), places_(stride_ * candidates.size()) {
  make_segments(candidates, vertex_count);
}

SegmentIndex::Filed SegmentIndex::file(const Candidates& candidates, std::size_t vertex_count) const {
  Filed filed;
  filed.offsets.assign(vertex_count + 1, 0);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for_each_pair(candidates, i, [&](std::size_t, Vertex low, Vertex, bool) { ++filed.offsets[low + 1]; });
  std::partial_sum(filed.offsets.begin(), filed.offsets.end(), filed.offsets.begin());
  filed.pairs.resize(filed.offsets.back());
  std::vector<std::int64_t> next(filed.offsets.begin(), filed.offsets.end() - 1);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for_each_pair(candidates, i, [&](std::size_t pair, Vertex low, Vertex, bool) {
      filed.pairs[next[low]++] = static_cast<std::int64_t>(stride_ * i + pair);
    });
  return filed;
}

// A vertex has at most one segment for each pair filed under it, so that there is room for all before they are counted.
void SegmentIndex::make_segments(const Candidates& candidates, std::size_t vertex_count) {
  const Filed filed = file(candidates, vertex_count);
  const auto pairs_of = [&](std::int64_t v) {
    return std::span(filed.pairs).subspan(filed.offsets[v], filed.offsets[v + 1] - filed.offsets[v]);
  };
  struct Place {
    std::size_t candidate, pair;
    CornerPair corners;
    Vertex high;
  };
  const auto place_of = [&](std::int64_t filed_pair) {
    const auto at = static_cast<std::size_t>(filed_pair);
    const std::size_t candidate = at / stride_, pair = at % stride_;
    const CornerPair corners = corners_of(candidates.kind[candidate], pair);
    const auto& row = candidates.vertices[candidate];
    return Place{candidate, pair, corners, std::max(row[corners.a], row[corners.b])};
  };

  offsets_.assign(vertex_count + 1, 0);
  PerThread<SegmentMaker> makers(SegmentMaker{vertex_count});
  parallel_for(static_cast<std::int64_t>(vertex_count), vertices_a_block, [&](std::int64_t v) {
    SegmentMaker& maker = makers.local();
    for (const std::int64_t pair : pairs_of(v)) maker.number(place_of(pair).high);
    offsets_[v + 1] = static_cast<std::int64_t>(header * maker.segments().size() + pairs_of(v).size());
    maker.clear();
  });
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  entries_.resize(offsets_.back());
  parallel_for(static_cast<std::int64_t>(vertex_count), vertices_a_block, [&](std::int64_t v) {
    SegmentMaker& maker = makers.local();
    for (const std::int64_t pair : pairs_of(v)) {
      const Place place = place_of(pair);
      ++maker.segments()[maker.number(place.high)].counts[place.corners.is_edge ? 0 : 1];
    }
    std::int32_t* const entries = entries_.data() + offsets_[v];
    std::uint32_t begin = 0;
    for (auto& segment : maker.segments()) {
      segment.begin = begin;
      entries[begin] = segment.counts[0];
      entries[begin + 1] = segment.counts[1];
      const auto edges = segment.counts[0], others = segment.counts[1];
      segment.counts = {static_cast<std::int32_t>(header), static_cast<std::int32_t>(header) + edges};
      begin += static_cast<std::uint32_t>(header) + static_cast<std::uint32_t>(edges + others);
    }
    for (const std::int64_t pair : pairs_of(v)) {
      const Place place = place_of(pair);
      auto& segment = maker.segments()[maker.number(place.high)];
      entries[segment.begin + static_cast<std::uint32_t>(segment.counts[place.corners.is_edge ? 0 : 1]++)] =
          static_cast<std::int32_t>(place.candidate);
      places_[stride_ * place.candidate + place.pair] = segment.begin;
    }
    maker.clear();
  });
}

}  // namespace hexpipe
