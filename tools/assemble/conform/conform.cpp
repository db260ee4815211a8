// Puts a pyramid on every quad that faces two tets. If the two share their fourth vertex, they merge into the pyramid;
// otherwise the ring of tets around the quad's diagonal is filled anew from a vertex inside (cavity.hpp). If neither
// gives acceptable elements, the cell goes back to its tets, and its neighbours' quads come up in the next round.
// S. J. Owen, S. A. Canann, S. Saigal, "Pyramid elements for maintaining tetrahedra to hexahedra conformability"
// (1997). They leave bad pyramids to smoothing; here the cells are given back, because the mesh has to be valid.

#include "tools/assemble/conform/conform.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <vector>

#include "common/mesh/quality.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/conform/cavity.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::conform {
namespace {

// A merged pyramid this good is taken at once: it adds no vertex, and a split is seldom better.
constexpr double good_pyramid = 0.25;
// Below this the cavity grows.
constexpr double good_cavity = 0.06;
// Elements at a quad have to reach this at its first turn. The other quads wait until these have taken their tets.
constexpr double accepted_at_once = 0.02;

// A corner with a smaller scaled Jacobian lies in one plane, to the precision of surface files. On curved surfaces,
// sliding vertices have opened corners of 0.01 and even inverted ones.
constexpr double flat_corner = 1e-3;

class Conformer {
 public:
  Conformer(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, const Candidates& candidates,
            double least_quality)
      : mesh_(mesh), tags_(tags), candidates_(candidates), least_quality_(least_quality) {}

  ConformityCounts run() {
    std::vector<choice::OpenQuad> open = choice::open_quads(mesh_);
    counts_.open_quads = static_cast<std::int64_t>(open.size());
    while (!open.empty()) open = round(open);
    return counts_;
  }

 private:
  struct Failure {
    choice::OpenQuad at;
    GivenBack reason;
  };

  std::vector<choice::OpenQuad> round(std::vector<choice::OpenQuad>& open);
  void absorb_sliver(const choice::OpenQuad& at);
  bool is_done(const choice::OpenQuad& at) const { return !choice::is_open(mesh_, at.cell, at.quad); }
  VertexKey<2> diagonal_of(const choice::OpenQuad& at) const;
  std::optional<Vertex> common_apex(const choice::OpenQuad& at) const;
  std::optional<hybrid::HybridCell> merged_pyramid(const choice::OpenQuad& at) const;
  bool has_flat_corner(const choice::OpenQuad& at) const;
  double quality_of(const hybrid::HybridCell& pyramid) const;
  void merge(const choice::OpenQuad& at, const hybrid::HybridCell& pyramid);
  std::optional<GivenBack> resolve(const choice::OpenQuad& at, double least);
  void give_back(CellIndex cell, std::vector<choice::OpenQuad>& open);
  void free_quad(const hybrid::HybridCell& cell, int i, CellIndex partner, std::vector<choice::OpenQuad>& open);

  hybrid::HybridMesh& mesh_;
  const hybrid::SurfaceTags& tags_;
  const Candidates& candidates_;
  double least_quality_;
  // The diagonals of open quads: no pyramid may have one as its edge.
  KeySet<2> diagonals_;
  ConformityCounts counts_;
};

VertexKey<2> Conformer::diagonal_of(const choice::OpenQuad& at) const {
  const hybrid::HybridCell& cell = mesh_.cell(at.cell);
  const Quad quad = cell.quad(at.quad);
  const int diagonal = cell.outer_diagonal(at.quad);
  return edge_key(quad[diagonal], quad[diagonal + 2]);
}

// If both triangles of the quad belong to one tet, the quad takes its other diagonal.
void Conformer::absorb_sliver(const choice::OpenQuad& at) {
  const hybrid::HybridCell& cell = mesh_.cell(at.cell);
  const Quad quad = cell.quad(at.quad);
  const int diagonal = cell.outer_diagonal(at.quad);
  const auto near = triangles_of(quad, diagonal), far = triangles_of(quad, 1 - diagonal);
  const TetIndex sliver = mesh_.tet_at(near[0]);
  if (sliver != mesh_.tet_at(near[1]) || cell.sliver[at.quad] != no_index) return;
  if (tags_.contains(near[0]) || tags_.contains(near[1]) || tags_.covers_partly(quad, 1 - diagonal)) return;
  const bool on_boundary = tags_.cover_of(quad, 1 - diagonal).has_value();
  int tets = 0;
  for (const auto& half : far) tets += mesh_.tet_at(half, sliver) != no_index;
  if (tets != 2 && !(tets == 0 && on_boundary)) return;
  mesh_.remove_tet(sliver);
  mesh_.set_sliver(at.cell, at.quad, sliver);
  ++counts_.absorbed;
}

// The fourth vertex of both tets at an open quad, if they share it and the facet between them is not tagged.
std::optional<Vertex> Conformer::common_apex(const choice::OpenQuad& at) const {
  const hybrid::HybridCell& cell = mesh_.cell(at.cell);
  const Quad quad = cell.quad(at.quad);
  const auto halves = triangles_of(quad, cell.outer_diagonal(at.quad));
  const TetIndex first = mesh_.tet_at(halves[0]), second = mesh_.tet_at(halves[1]);
  auto apex_of = [&](TetIndex t) {
    return *std::find_if(mesh_.tet(t).begin(), mesh_.tet(t).end(),
                         [&](Vertex v) { return std::find(quad.begin(), quad.end(), v) == quad.end(); });
  };
  if (first == second) return std::nullopt;
  const Vertex apex = apex_of(first);
  if (apex != apex_of(second) || mesh_.region_of(first) != mesh_.region_of(second)) return std::nullopt;
  const auto diagonal = diagonal_of(at);
  if (tags_.contains({diagonal[0], diagonal[1], apex})) return std::nullopt;
  return apex;
}

// Whether, at a corner of the quad, its two edges and the edge to the common apex lie in a flat part of the surface: no
// cell on the quad has volume there.
bool Conformer::has_flat_corner(const choice::OpenQuad& at) const {
  const auto apex = common_apex(at);
  if (!apex) return false;
  const hybrid::HybridCell& cell = mesh_.cell(at.cell);
  const Quad quad = cell.quad(at.quad);
  for (int corner = cell.outer_diagonal(at.quad); corner < 4; corner += 2) {
    const Vertex o = quad[corner], next = quad[(corner + 1) % 4], last = quad[(corner + 3) % 4];
    if (!tags_.contains({o, next, *apex}) || !tags_.contains({o, last, *apex})) continue;
    const Vec3 origin = mesh_.points[o];
    const double quality =
        scaled_jacobian(mesh_.points[next] - origin, mesh_.points[last] - origin, mesh_.points[*apex] - origin);
    if (std::abs(quality) < flat_corner) return true;
  }
  return false;
}

std::optional<hybrid::HybridCell> Conformer::merged_pyramid(const choice::OpenQuad& at) const {
  const auto common = common_apex(at);
  if (!common) return std::nullopt;
  const Quad quad = mesh_.cell(at.cell).quad(at.quad);
  const Vertex apex = *common;
  for (Vertex v : quad)
    if (diagonals_.contains(edge_key(v, apex))) return std::nullopt;
  hybrid::HybridCell pyramid;
  pyramid.kind = CellKind::pyramid;
  pyramid.corners = {quad[0], quad[1], quad[2], quad[3], apex, -1, -1, -1};
  pyramid.region = mesh_.region_of(mesh_.tet_at(triangles_of(quad, mesh_.cell(at.cell).outer_diagonal(at.quad))[0]));
  return pyramid;
}

double Conformer::quality_of(const hybrid::HybridCell& pyramid) const {
  std::array<Vec3, 5> corners;
  for (int i = 0; i < 5; ++i) corners[i] = mesh_.points[pyramid.corners[i]];
  shape::PointStar star;
  star.add(CellKind::pyramid, corners, 4);
  return star.worst(corners[4]);
}

void Conformer::merge(const choice::OpenQuad& at, const hybrid::HybridCell& pyramid) {
  const hybrid::HybridCell& cell = mesh_.cell(at.cell);
  diagonals_.erase(diagonal_of(at));
  for (const auto& half : triangles_of(cell.quad(at.quad), cell.outer_diagonal(at.quad)))
    mesh_.remove_tet(mesh_.tet_at(half));
  mesh_.add_cell(pyramid);
  ++counts_.merged;
}

// Takes the better of merging and splitting, or returns the reason why neither is acceptable.
std::optional<GivenBack> Conformer::resolve(const choice::OpenQuad& at, double least) {
  const hybrid::HybridCell& cell = mesh_.cell(at.cell);
  const auto pyramid = merged_pyramid(at);
  const double merged_quality = pyramid ? quality_of(*pyramid) : -1;
  if (merged_quality >= good_pyramid) {
    merge(at, *pyramid);
    return std::nullopt;
  }
  Cavity cavity(mesh_, tags_, cell.quad(at.quad), cell.outer_diagonal(at.quad));
  const bool ball = cavity.obstacle() == Cavity::Obstacle::none;
  const double split_quality = ball ? cavity.place_vertex(good_cavity) : -1;
  if (std::max(merged_quality, split_quality) < least) {
    if (ball) return GivenBack::no_valid_position;
    return cavity.obstacle() == Cavity::Obstacle::surface ? GivenBack::diagonal_on_surface : GivenBack::diagonal_in_use;
  }
  if (merged_quality >= split_quality) {
    merge(at, *pyramid);
    return std::nullopt;
  }
  diagonals_.erase(diagonal_of(at));
  cavity.split(mesh_);
  ++counts_.split;
  return std::nullopt;
}

// Quad i of a removed cell: makes what is on its other side conform with the cell's tets.
void Conformer::free_quad(const hybrid::HybridCell& cell, int i, CellIndex partner,
                          std::vector<choice::OpenQuad>& open) {
  const TetIndex sliver = cell.sliver[i];
  if (partner == no_index) {
    if (sliver != no_index) mesh_.restore_tet(sliver);
    return;
  }
  const hybrid::HybridCell& other = mesh_.cell(partner);
  if (other.candidate == no_index) {
    // Both diagonals cut a valid pyramid into two positive tets: its corner determinants are theirs.
    const Vertex apex = other.corners[4];
    const std::int32_t region = other.region;
    mesh_.remove_cell(partner);
    for (const auto& half : triangles_of(cell.quad(i), cell.outer_diagonal(i)))
      mesh_.add_tet({half[0], half[1], half[2], apex}, region);
    if (sliver != no_index) mesh_.restore_tet(sliver);
    return;
  }
  int theirs = 0;
  while (key_of(other.quad(theirs)) != key_of(cell.quad(i))) ++theirs;
  if (sliver != no_index && other.sliver[theirs] != sliver) mesh_.restore_tet(sliver);
  open.push_back({partner, theirs});
}

void Conformer::give_back(CellIndex c, std::vector<choice::OpenQuad>& open) {
  const hybrid::HybridCell cell = mesh_.cell(c);
  std::array<CellIndex, 6> partners;
  for (int i = 0; i < cell.quad_count(); ++i) {
    partners[i] = mesh_.partner_at(c, i);
    if (choice::is_open(mesh_, c, i)) diagonals_.erase(diagonal_of({c, i}));
  }
  mesh_.remove_cell(c);
  for (TetIndex t : candidates_.interior_tets_of(cell.candidate)) mesh_.restore_tet(t);
  for (int i = 0; i < cell.quad_count(); ++i) free_quad(cell, i, partners[i], open);
  if (cell.kind == CellKind::hex) counts_.volume_given_back += candidates_.volume[cell.candidate];
}

// One round: slivers, then merges that are good at once, then the other quads one by one. Returns the quads that are
// open because cells were given back.
std::vector<choice::OpenQuad> Conformer::round(std::vector<choice::OpenQuad>& open) {
  for (const auto& at : open)
    if (mesh_.cell(at.cell).alive && !is_done(at)) absorb_sliver(at);
  std::erase_if(open, [&](const choice::OpenQuad& at) { return !mesh_.cell(at.cell).alive || is_done(at); });
  for (const auto& at : open) diagonals_.insert(diagonal_of(at));
  std::erase_if(open, [&](const choice::OpenQuad& at) {
    const auto pyramid = merged_pyramid(at);
    if (!pyramid || quality_of(*pyramid) < good_pyramid) return false;
    merge(at, *pyramid);
    return true;
  });
  std::erase_if(open,
                [&](const choice::OpenQuad& at) { return !resolve(at, std::max(accepted_at_once, least_quality_)); });
  std::vector<Failure> failures;
  for (const auto& at : open)
    if (const auto reason = has_flat_corner(at) ? std::optional(GivenBack::flat_corner) : resolve(at, least_quality_))
      failures.push_back({at, *reason});
  std::vector<choice::OpenQuad> next;
  for (const auto& [at, reason] : failures) {
    if (!mesh_.cell(at.cell).alive) continue;
    give_back(at.cell, next);
    ++counts_.given_back[static_cast<std::size_t>(reason)];
  }
  return next;
}

}  // namespace

ConformityCounts make_conforming(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags,
                                 const Candidates& candidates, double least_quality) {
  return Conformer(mesh, tags, candidates, least_quality).run();
}

}  // namespace hexpipe::assemble::conform
