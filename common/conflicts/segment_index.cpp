#include "common/conflicts/segment_index.hpp"

#include <algorithm>
#include <numeric>

#include "common/run/memory.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::conflicts {
namespace {

constexpr std::int64_t vertices_a_block = 256;

// The place of a pair of corners in corner_pairs.
template <class Topology>
constexpr auto make_pair_numbers() {
  std::array<std::array<std::uint8_t, Topology::corner_count>, Topology::corner_count> numbers{};
  for (std::size_t pair = 0; pair < corner_pairs<Topology>.size(); ++pair) {
    const CornerPair& corners = corner_pairs<Topology>[pair];
    numbers[corners.a][corners.b] = numbers[corners.b][corners.a] = static_cast<std::uint8_t>(pair);
  }
  return numbers;
}
template <class Topology>
constexpr auto pair_numbers = make_pair_numbers<Topology>();

// Calls visit(pair, higher vertex, whether they are an edge) for the pairs whose lower vertex is `low`.
template <class Visit>
void for_each_pair_above(const Candidates& candidates, std::size_t i, Vertex low, Visit&& visit) {
  with_topology(candidates.kind[i], [&]<class Topology>(Topology) {
    const auto& corners = candidates.vertices[i];
    const auto own = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), low) - corners.begin());
    for (std::size_t other = 0; other < Topology::corner_count; ++other) {
      if (corners[other] <= low) continue;
      const std::size_t pair = pair_numbers<Topology>[own][other];
      visit(pair, corners[other], corner_pairs<Topology>[pair].is_edge);
    }
  });
}

std::size_t most_pairs(const Candidates& candidates) {
  std::size_t most = 0;
  for (const CellKind kind : {CellKind::pyramid, CellKind::prism, CellKind::hex})
    if (std::find(candidates.kind.begin(), candidates.kind.end(), kind) != candidates.kind.end())
      most = with_topology(kind, []<class Topology>(Topology) { return corner_pairs<Topology>.size(); });
  return most;
}

// Collects the segments at one lower vertex after another, and numbers them by their higher vertex in order of
// appearance.
class SegmentMaker {
 public:
  explicit SegmentMaker(std::size_t vertex_count) : number_of_(vertex_count, no_index) {}

  std::int32_t number(Vertex high) {
    if (number_of_[high] == no_index) {
      number_of_[high] = static_cast<std::int32_t>(segments_.size());
      segments_.push_back({high, {0, 0}, 0});
    }
    return number_of_[high];
  }

  struct Segment {
    Vertex high;
    std::array<std::int32_t, 2> counts;  // of candidates where it is an edge, and where it is not
    std::uint32_t begin;
  };
  std::vector<Segment>& segments() { return segments_; }

  void clear() {
    for (const Segment& segment : segments_) number_of_[segment.high] = no_index;
    segments_.clear();
  }

 private:
  std::vector<std::int32_t> number_of_;  // by higher vertex
  std::vector<Segment> segments_;
};

constexpr std::size_t header = 2;

}  // namespace

SegmentIndex::SegmentIndex(const Candidates& candidates, std::size_t vertex_count) : stride_(most_pairs(candidates)) {
  resize_in_huge_pages(places_, stride_ * candidates.size());
  make_segments(candidates, vertex_count);
}

SegmentIndex::Filed SegmentIndex::file(const Candidates& candidates, std::size_t vertex_count) {
  Filed filed;
  filed.offsets.assign(vertex_count + 1, 0);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (const Vertex v : candidates.corners_of(i)) ++filed.offsets[v + 1];
  std::partial_sum(filed.offsets.begin(), filed.offsets.end(), filed.offsets.begin());
  resize_in_huge_pages(filed.candidates, static_cast<std::size_t>(filed.offsets.back()));
  std::vector<std::int64_t> next(filed.offsets.begin(), filed.offsets.end() - 1);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (const Vertex v : candidates.corners_of(i)) filed.candidates[next[v]++] = CandidateIndex(i);
  return filed;
}

void SegmentIndex::make_segments(const Candidates& candidates, std::size_t vertex_count) {
  const Filed filed = file(candidates, vertex_count);
  // Calls visit(candidate, pair, higher vertex, whether they are an edge).
  const auto for_each_pair_at = [&](std::int64_t v, auto&& visit) {
    for (std::int64_t at = filed.offsets[v]; at < filed.offsets[v + 1]; ++at) {
      const auto i = static_cast<std::size_t>(filed.candidates[at]);
      for_each_pair_above(candidates, i, static_cast<Vertex>(v), [&](std::size_t pair, Vertex high, bool is_edge) {
        visit(filed.candidates[at], stride_ * i + pair, high, is_edge ? 0 : 1);
      });
    }
  };

  offsets_.assign(vertex_count + 1, 0);
  PerThread<SegmentMaker> makers(SegmentMaker{vertex_count});
  parallel_for(static_cast<std::int64_t>(vertex_count), vertices_a_block, [&](std::int64_t v) {
    SegmentMaker& maker = makers.local();
    std::int64_t pairs = 0;
    for_each_pair_at(v, [&](CandidateIndex, std::size_t, Vertex high, int) {
      maker.number(high);
      ++pairs;
    });
    offsets_[v + 1] = static_cast<std::int64_t>(header * maker.segments().size()) + pairs;
    maker.clear();
  });
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  resize_in_huge_pages(entries_, static_cast<std::size_t>(offsets_.back()));
  parallel_for(static_cast<std::int64_t>(vertex_count), vertices_a_block, [&](std::int64_t v) {
    SegmentMaker& maker = makers.local();
    for_each_pair_at(v, [&](CandidateIndex, std::size_t, Vertex high, int way) {
      ++maker.segments()[maker.number(high)].counts[way];
    });
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
    for_each_pair_at(v, [&](CandidateIndex candidate, std::size_t place, Vertex high, int way) {
      auto& segment = maker.segments()[maker.number(high)];
      entries[segment.begin + static_cast<std::uint32_t>(segment.counts[way]++)] = candidate;
      places_[place] = segment.begin;
    });
    maker.clear();
  });
}

}  // namespace hexpipe::conflicts
