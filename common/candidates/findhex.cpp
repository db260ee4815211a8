#include "common/candidates/findhex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "common/candidates/cell_search.hpp"
#include "common/candidates/quads.hpp"
#include "common/mesh/cell_measures.hpp"
#include "common/mesh/lanes.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/run/parallel.hpp"
#include "common/run/progress.hpp"

namespace hexpipe::candidates {
namespace {

constexpr std::int64_t vertices_a_block = 64;

struct Found {
  Candidates candidates;
  CellCounts counts;
};

void append_tets(std::span<const TetIndex> added, std::vector<TetIndex>& tets, std::vector<std::int64_t>& offsets) {
  tets.insert(tets.end(), added.begin(), added.end());
  offsets.push_back(static_cast<std::int64_t>(tets.size()));
}

// Applies rules 4 to 7, 9 and 10 to the cells that the search has completed, and keeps those that obey them all. It
// measures a few cells side by side.
template <class Topology>
class CandidateCollector {
 public:
  using CellCorners = std::array<Vertex, Topology::corner_count>;
  using CellPoints = std::array<Vec3, Topology::corner_count>;

  CandidateCollector(const MeshTables& tables, const FindhexOptions& options, CellMarks& marks)
      : options_(options), tets_(tables, options.tet_rules, marks) {}

  void add(const CellCorners& corners, const CellPoints& points, Diagonals of_first_quad) {
    corners_[waiting_] = corners;
    points_[waiting_] = points;
    diagonals_[waiting_] = of_first_quad;
    if (++waiting_ == lane_count) judge();
  }

  Found take() {
    judge();
    return std::move(found_);
  }

 private:
  // Judges the waiting cells. Lanes without a cell hold old values.
  void judge() {
    const auto points = side_by_side(points_);
    std::uint32_t surely_valid = 0;
    if constexpr (Topology::kind == CellKind::hex) surely_valid = surely_valid_hexes(points);
    CellMeasures measures;
    measure_cells(points, measures);
    const int count = std::exchange(waiting_, 0);
    for (int lane = 0; lane < count; ++lane) {
      ++found_.counts.complete;
      if ((surely_valid >> lane & 1) == 0 && !is_valid(Topology::kind, points_[lane])) {
        ++found_.counts.invalid;
        continue;
      }
      const TetVerdict verdict = tets_.find(corners_[lane], diagonals_[lane]);
      ++found_.counts.by_verdict[static_cast<int>(verdict)];
      if (verdict != TetVerdict::accepted) continue;
      keep(corners_[lane],
           options_.quality == CandidateQuality::corner ? measures.quality[lane]
                                                        : least_scaled_jacobian(Topology::kind, points_[lane]),
           measures.volume[lane]);
    }
  }

  void keep(const CellCorners& corners, double quality, double volume) {
    Candidates& c = found_.candidates;
    std::array<Vertex, 8>& row = c.vertices.emplace_back();
    row.fill(no_index);
    std::copy(corners.begin(), corners.end(), row.begin());
    c.kind.push_back(Topology::kind);
    c.quality.push_back(quality);
    c.volume.push_back(volume);
    append_tets(tets_.interior(), c.tets, c.tet_offsets);
    append_tets(tets_.boundary(), c.boundary_tets, c.boundary_tet_offsets);
  }

  const FindhexOptions& options_;
  CellTets<Topology> tets_;
  Found found_;
  std::array<CellCorners, lane_count> corners_{};
  std::array<CellPoints, lane_count> points_{};
  std::array<Diagonals, lane_count> diagonals_{};
  int waiting_ = 0;
};

// The search for one kind of cell, at one vertex after another.
class KindSearch {
 public:
  virtual ~KindSearch() = default;
  virtual void search_at(Vertex corner_0, const QuadFan& fan) = 0;
  virtual Found take() = 0;
};

template <class Topology>
class KindSearchOf final : public KindSearch {
 public:
  KindSearchOf(const MeshTables& tables, const QuadFilter& filter, const FindhexOptions& options, CellMarks& marks)
      : collector_(tables, options, marks), search_(tables, filter, Judge{collector_}) {}

  void search_at(Vertex corner_0, const QuadFan& fan) override { search_.visit_cells_at(corner_0, fan); }
  Found take() override { return collector_.take(); }

 private:
  struct Judge {
    CandidateCollector<Topology>& collector;
    void operator()(const auto& corners, const auto& points, Diagonals of_first_quad) {
      collector.add(corners, points, of_first_quad);
    }
  };
  CandidateCollector<Topology> collector_;
  CellSearch<Topology, Judge> search_;
};

struct FoundInBlock {
  std::int64_t quads = 0;
  std::vector<Found> by_kind;  // in the order of FindhexOptions::kinds
};

// Searches for all kinds together, so that the quads of a vertex are found once.
FoundInBlock find_cells_at(std::int64_t begin, std::int64_t end, const MeshTables& tables,
                           const FindhexOptions& options, const SearchScope& scope, CellMarks& marks) {
  const QuadFilter filter{options.min_quality, options.drop_folded_quads};
  std::vector<std::unique_ptr<KindSearch>> searches;
  for (const CellKind kind : options.kinds)
    with_topology(kind, [&]<class Topology>(Topology) {
      if constexpr (Topology::kind != CellKind::tet)
        searches.push_back(std::make_unique<KindSearchOf<Topology>>(tables, filter, options, marks));
    });
  FoundInBlock found;
  QuadFan fan(tables.mesh(), tables.links(), filter);
  for (std::int64_t v = begin; v < end; ++v) {
    if (!scope.begins_at.empty() && !scope.begins_at[v]) continue;
    fan.find(static_cast<Vertex>(v));
    found.quads += static_cast<std::int64_t>(fan.size());
    for (const auto& search : searches) search->search_at(static_cast<Vertex>(v), fan);
  }
  for (const auto& search : searches) found.by_kind.push_back(search->take());
  return found;
}

}  // namespace

CellCounts& CellCounts::operator+=(const CellCounts& other) {
  complete += other.complete;
  invalid += other.invalid;
  for (std::size_t i = 0; i < by_verdict.size(); ++i) by_verdict[i] += other.by_verdict[i];
  return *this;
}

FindhexResult findhex(TetMesh mesh, const FindhexOptions& options, const char* source, const SearchScope& scope) {
  Step all("reading the tets");
  const MeshTables tables(std::move(mesh), source, scope.turns, options.feature_angle);
  FindhexResult result;
  result.findings = tables.findings();
  for (const CellKind kind : options.kinds) result.counts.push_back({kind, {}});
  const auto vertex_count = static_cast<std::int64_t>(tables.mesh().points.size());
  const std::int64_t first = options.share.begin(vertex_count), count = options.share.end(vertex_count) - first;
  std::vector<Candidates> by_kind(options.kinds.size());
  std::int64_t vertices_done = 0, cells_found = 0;
  Step step("looking for hexes", 0.05);
  step.expect(count);
  PerThread<CellMarks> marks{CellMarks(tables.mesh())};
  parallel_in_order(
      count, vertices_a_block,
      [&](std::int64_t begin, std::int64_t end) {
        return find_cells_at(first + begin, first + end, tables, options, scope, marks.local());
      },
      [&](FoundInBlock&& found) {
        vertices_done = std::min(vertices_done + vertices_a_block, count);
        step.advance(vertices_a_block);
        const double share_done = static_cast<double>(vertices_done) / static_cast<double>(count);
        result.triangulated_quads += found.quads;
        for (std::size_t kind = 0; kind < by_kind.size(); ++kind) {
          append(by_kind[kind], found.by_kind[kind].candidates, share_done);
          result.counts[kind].counts += found.by_kind[kind].counts;
          cells_found += static_cast<std::int64_t>(found.by_kind[kind].candidates.size());
        }
        if (step.due()) step.say(fmt::format("{} candidates", cells_found));
      });
  for (Candidates& candidates : by_kind) {
    if (result.candidates.size() == 0)
      result.candidates = std::move(candidates);
    else
      append(result.candidates, std::exchange(candidates, {}));
  }
  return result;
}

}  // namespace hexpipe::candidates
