#include "tools/assemble/assemble.hpp"

#include "common/mesh/adjacency.hpp"
#include "common/mesh/validity.hpp"
#include "common/run/error.hpp"
#include "tools/assemble/conform.hpp"
#include "tools/assemble/extract.hpp"
#include "tools/assemble/selection.hpp"
#include "tools/assemble/self_check.hpp"
#include "tools/assemble/smooth.hpp"
#include "tools/assemble/surface_tags.hpp"

namespace hexpipe {
namespace {

// Boundary facets that no triangle of the input names get this tag, as in findhex.
constexpr std::int32_t untagged = 0;

void check_orientation(const TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    if (orientation(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) <= 0)
      throw DataError::at("mesh", "expected positively oriented tets, found tet {} flat or inverted", t + 1);
  }
}

void check_chosen(const IndependentSet& chosen, const Candidates& candidates) {
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] < 0 || static_cast<std::size_t>(chosen[i]) >= candidates.size())
      throw DataError::at("solution", "expected candidates from 1 to {}, found {}", candidates.size(), chosen[i] + 1);
    if (i > 0 && chosen[i] <= chosen[i - 1])
      throw DataError::at("solution", "expected ascending candidates, found {} after {}", chosen[i] + 1,
                          chosen[i - 1] + 1);
  }
}

bool is_facet_of_a_tet(const Triangle& triangle, const TetMesh& mesh, const TetAdjacency& adjacency) {
  for (std::int32_t t : adjacency.tets_at(triangle[0])) {
    const Tet& tet = mesh.tets[t];
    auto has = [&](Vertex v) { return tet[0] == v || tet[1] == v || tet[2] == v || tet[3] == v; };
    if (has(triangle[1]) && has(triangle[2])) return true;
  }
  return false;
}

// The input with all boundary and interface facets among its triangles, and no others than facets of tets.
TetMesh with_complete_surface(const TetMesh& mesh) {
  TetMesh result = mesh;
  const TetAdjacency adjacency(mesh, "mesh");
  std::size_t kept = 0;
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    if (!is_facet_of_a_tet(result.triangles[i], mesh, adjacency)) continue;
    result.triangles[kept] = result.triangles[i];
    result.triangle_tags[kept++] = result.triangle_tags[i];
  }
  result.triangles.resize(kept);
  result.triangle_tags.resize(kept);
  add_missing_boundary_triangles(result, adjacency, untagged);
  return result;
}

}  // namespace

AssembleResult assemble(const TetMesh& mesh, const Candidates& candidates, const IndependentSet& chosen,
                        const AssembleOptions& options) {
  validate_against(candidates, mesh, "candidates");
  check_chosen(chosen, candidates);
  check_orientation(mesh);
  const TetMesh input = with_complete_surface(mesh);
  const SurfaceTags tags(input);
  HybridMesh hybrid = build_selection(input, tags, candidates, chosen);
  const bool conforming = options.conformity == AssembleOptions::Conformity::pyramids;

  AssembleResult result;
  if (conforming) result.statistics.conformity = make_conforming(hybrid, tags, candidates);
  Extract extracted = extract(hybrid, input, tags);
  if (options.smooth > 0) {
    compute_quality(extracted.mesh);
    result.statistics.before_smoothing = kind_statistics(extracted.mesh);
    result.statistics.smoothing = smooth(extracted.mesh, options.smooth);
  }
  result.statistics.volumes = check_result(extracted, input, tags, conforming, options.smooth > 0);
  compute_quality(extracted.mesh);
  result.mesh = std::move(extracted.mesh);
  result.statistics.kinds = kind_statistics(result.mesh);
  result.statistics.points = static_cast<std::int64_t>(result.mesh.points.size());
  result.statistics.triangles = static_cast<std::int64_t>(result.mesh.triangles.size());
  result.statistics.quads = static_cast<std::int64_t>(result.mesh.quads.size());
  return result;
}

}  // namespace hexpipe
