#include "tools/findhex/findhex.hpp"

#include <algorithm>
#include <iterator>

#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/run/parallel.hpp"
#include "tools/findhex/cell_search.hpp"
#include "tools/findhex/quad_table.hpp"

namespace hexpipe {
namespace {

constexpr std::int64_t vertices_a_block = 64;

struct Found {
  Candidates candidates;
  CellCounts counts;
};

void append_tets(std::span<const std::int32_t> added, std::vector<std::int32_t>& tets,
                 std::vector<std::int64_t>& offsets) {
  tets.insert(tets.end(), added.begin(), added.end());
  offsets.push_back(static_cast<std::int64_t>(tets.size()));
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void append_offsets(std::vector<std::int64_t>& to, const std::vector<std::int64_t>& from) {
  const std::int64_t base = to.back();
  std::transform(from.begin() + 1, from.end(), std::back_inserter(to), [base](std::int64_t at) { return base + at; });
}

void append(Candidates& to, const Candidates& from) {
  append(to.vertices, from.vertices);
  append(to.kind, from.kind);
  append(to.quality, from.quality);
  append(to.volume, from.volume);
  append(to.tets, from.tets);
  append_offsets(to.tet_offsets, from.tet_offsets);
  append(to.boundary_tets, from.boundary_tets);
  append_offsets(to.boundary_tet_offsets, from.boundary_tet_offsets);
}

// Rules 4 to 7 for cells that the search has completed; keeps those that hold them all.
template <class Topology>
class CandidateCollector {
 public:
  CandidateCollector(const MeshTables& tables, const FindhexOptions& options)
      : options_(options), tets_(tables, options.tet_rules) {}

  void judge(const std::array<Vertex, Topology::corner_count>& corners,
             const std::array<Vec3, Topology::corner_count>& points) {
    ++found_.counts.complete;
    if (!is_valid(Topology::kind, points)) {
      ++found_.counts.invalid;
      return;
    }
    const TetVerdict verdict = tets_.find(corners);
    ++found_.counts.by_verdict[static_cast<int>(verdict)];
    if (verdict != TetVerdict::accepted) return;

    Candidates& c = found_.candidates;
    std::array<Vertex, 8>& row = c.vertices.emplace_back();
    row.fill(-1);
    std::copy(corners.begin(), corners.end(), row.begin());
    c.kind.push_back(Topology::kind);
    c.quality.push_back(options_.quality == CandidateQuality::corner
                            ? least_corner_scaled_jacobian(Topology::kind, points)
                            : least_scaled_jacobian(Topology::kind, points));
    c.volume.push_back(cell_volume(Topology::kind, points));
    append_tets(tets_.interior(), c.tets, c.tet_offsets);
    append_tets(tets_.boundary(), c.boundary_tets, c.boundary_tet_offsets);
  }

  Found take() { return std::move(found_); }

 private:
  const FindhexOptions& options_;
  CellTets<Topology> tets_;
  Found found_;
};

template <class Topology>
Found find_cells_at(std::int64_t begin, std::int64_t end, const MeshTables& tables, const QuadTable& quads,
                    const FindhexOptions& options) {
  CandidateCollector<Topology> collector(tables, options);
  auto judge = [&](const auto& corners, const auto& points) { collector.judge(corners, points); };
  CellSearch<Topology, decltype(judge)> search(tables, quads, options.min_quality, judge);
  for (std::int64_t v = begin; v < end; ++v) search.visit_cells_at(static_cast<Vertex>(v));
  return collector.take();
}

template <class Topology>
CellCounts find_all(const MeshTables& tables, const QuadTable& quads, const FindhexOptions& options,
                    Candidates& candidates) {
  CellCounts counts;
  parallel_in_order(
      static_cast<std::int64_t>(tables.mesh().points.size()), vertices_a_block,
      [&](std::int64_t begin, std::int64_t end) { return find_cells_at<Topology>(begin, end, tables, quads, options); },
      [&](Found&& found) {
        append(candidates, found.candidates);
        counts += found.counts;
      });
  return counts;
}

}  // namespace

CellCounts& CellCounts::operator+=(const CellCounts& other) {
  complete += other.complete;
  invalid += other.invalid;
  for (std::size_t i = 0; i < by_verdict.size(); ++i) by_verdict[i] += other.by_verdict[i];
  return *this;
}

FindhexResult findhex(TetMesh mesh, const FindhexOptions& options, const char* source) {
  const MeshTables tables(std::move(mesh), source);
  const QuadTable quads(tables.mesh(), tables.adjacency(), tables.facets(),
                        {options.min_quality, options.drop_folded_quads});
  FindhexResult result;
  result.findings = tables.findings();
  result.triangulated_quads = static_cast<std::int64_t>(quads.size());
  for (const CellKind kind : options.kinds)
    with_topology(kind, [&]<class Topology>(Topology) {
      if constexpr (Topology::kind != CellKind::tet)
        result.counts.push_back({kind, find_all<Topology>(tables, quads, options, result.candidates)});
    });
  return result;
}

}  // namespace hexpipe
