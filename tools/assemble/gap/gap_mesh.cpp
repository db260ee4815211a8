#include "tools/assemble/gap/gap_mesh.hpp"

#include <algorithm>
#include <iterator>

#include "common/mesh/face_measures.hpp"
#include "common/mesh/face_view.hpp"
#include "common/mesh/item_lists.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

GapCell cell_of(CellKind kind, const std::array<Vertex, 6>& corners, std::int32_t region,
                const std::vector<Vec3>& points) {
  GapCell cell{kind, corners, region};
  cell.quality = quality_of(kind, points, cell.vertices());
  return cell;
}

Vec3 centre_at(std::span<const Vec3> points, CellKind kind, std::span<const Vertex> corners) {
  const auto at = corner_points(points, corners);
  return cell_centre(kind, std::span<const Vec3>(at).first(corners.size()));
}

}  // namespace

bool GapCell::has(Vertex v) const {
  return std::ranges::find(vertices(), v) != vertices().end();
}

int GapCell::count_common(const GapCell& other) const {
  return static_cast<int>(std::ranges::count_if(vertices(), [&](Vertex v) { return other.has(v); }));
}

double hex_volume_of(const GapMesh& gap) {
  double volume = 0;
  for (const auto k : indices<KeptIndex>(gap.kept_count())) {
    const KeptCell& cell = gap.kept_cell(k);
    if (cell.is_alive && cell.kind == CellKind::hex)
      volume += cell_volume(cell.kind, corner_points(gap.points(), cell.vertices()));
  }
  return volume;
}

std::vector<std::array<Vertex, 2>> edges_across_gap(const GapMesh& gap) {
  std::vector<std::array<Vertex, 2>> edges;
  for (const auto c : indices<GapIndex>(gap.cell_count())) {
    if (!gap.is_alive(c)) continue;
    const GapCell& cell = gap.cell(c);
    with_topology(cell.kind, [&](auto topology) {
      for (const auto& [i, k] : decltype(topology)::edges) {
        const Vertex a = cell.corners[i % 6], b = cell.corners[k % 6];
        if (gap.is_of_kept(a) && gap.is_of_kept(b)) edges.push_back({std::min(a, b), std::max(a, b)});
      }
    });
  }
  sort_unique(edges);
  const auto points = gap.points();
  std::ranges::stable_sort(edges, {}, [&](const auto& edge) { return norm(points[edge[0]] - points[edge[1]]); });
  return edges;
}

double shortest_edge_at(const GapMesh& gap, Vertex v) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const GapIndex c : gap.cells_at(v))
    for (const Vertex w : gap.cell(c).vertices())
      if (w != v) shortest = std::min(shortest, norm(gap.points()[w] - gap.points()[v]));
  return shortest;
}

bool is_valid(const GapMesh& gap, const GapCell& cell) {
  const auto at = corner_points(gap.points(), cell.vertices());
  return hexpipe::is_valid(cell.kind, std::span<const Vec3>(at).first(cell.vertices().size()));
}

GapMesh::GapMesh(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, std::span<const std::uint8_t> is_shared)
    : mesh_(mesh), tags_(tags), at_(mesh.points.size()), age_(mesh.points.size()), holds_(mesh.points.size()) {
  for (const auto t : indices<TetIndex>(mesh.tet_count()))
    if (mesh.is_alive(t)) add(make_tet(mesh.tet(t), mesh.region_of(t)), t);
  for (const auto c : indices<CellIndex>(mesh.cell_count())) {
    const hybrid::HybridCell& cell = mesh.cell(c);
    if (!cell.alive) continue;
    const std::span corners = std::span(cell.corners).first(static_cast<std::size_t>(corner_count(cell.kind)));
    if (cell.candidate == no_index && cell.kind != CellKind::hex) {
      std::array<Vertex, 6> own{};
      std::ranges::copy(corners, own.begin());
      add(cell_of(cell.kind, own, cell.region, mesh.points), c);
    } else {
      kept_.push_back({cell.kind, cell.corners, c, cell.region});
      for (const Vertex v : corners) holds_[v] |= of_kept;
    }
  }
  for (const auto i : indices<hybrid::TaggedTriangle>(tags.size()))
    for (const Vertex v : tags.triangle(i)) holds_[v] |= on_tagged;
  for (std::size_t v = 0; v < is_shared.size(); ++v)
    if (is_shared[v] != 0) holds_[v] |= at_seam;
  first_new_ = mesh.points.size();
  kept_at_.resize(first_new_);
  for (const auto c : indices<KeptIndex>(kept_.size()))
    for (const Vertex v : kept_[c].vertices()) kept_at_[v].push_back(c);
}

bool GapMesh::is_valid() const {
  constexpr double surely = 1e-6;
  for (const auto c : indices<GapIndex>(cells_.size()))
    if (alive_[c] != 0 && cells_[c].quality < surely && !gap::is_valid(*this, cells_[c])) return false;
  return true;
}

GapCell GapMesh::make(CellKind kind, const std::array<Vertex, 6>& corners, std::int32_t region) const {
  GapCell cell = cell_of(kind, corners, region, mesh_.points);
  if (looks_inverted(kind, mesh_.points, cell.vertices())) cell.quality = -1;
  return cell;
}

GapCell GapMesh::make_tet(const Tet& corners, std::int32_t region) const {
  return make(CellKind::tet, {corners[0], corners[1], corners[2], corners[3]}, region);
}

void GapMesh::add(const GapCell& cell, std::int32_t source) {
  const GapIndex c(cells_.size());
  cells_.push_back(cell);
  alive_.push_back(1);
  source_.push_back(source);
  link(c);
}

void GapMesh::link(GapIndex c) {
  alive_[c] = 1;
  for (const Vertex v : cells_[c].vertices()) {
    at_[v].push_back(c);
    ++age_[v];
  }
}

void GapMesh::unlink(GapIndex c) {
  alive_[c] = 0;
  for (const Vertex v : cells_[c].vertices()) {
    std::erase(at_[v], c);
    ++age_[v];
  }
}

const Vec3& GapMesh::centre_of(GapIndex c) const {
  centres_.resize(cells_.size());
  if (!centres_[c]) centres_[c] = centre_at(points(), cells_[c].kind, cells_[c].vertices());
  return *centres_[c];
}

const Vec3& GapMesh::centre_of_kept(KeptIndex c) const {
  kept_centres_.resize(kept_.size());
  if (!kept_centres_[c]) kept_centres_[c] = centre_at(points(), kept_[c].kind, kept_[c].vertices());
  return *kept_centres_[c];
}

void GapMesh::replace(std::span<const GapIndex> out, std::span<const GapCell> in) {
  for (const GapIndex c : out) unlink(c);
  for (const GapCell& cell : in) add(cell, no_index);
}

void GapMesh::undo_replace(std::span<const GapIndex> out, GapIndex first_new) {
  const auto left = static_cast<std::size_t>(first_new);
  for (const auto c : indices<GapIndex>(left, cells_.size())) unlink(c);
  cells_.resize(left), alive_.resize(left), source_.resize(left);
  if (centres_.size() > left) centres_.resize(left);
  if (face_costs_.size() > left) face_costs_.resize(left);
  for (const GapIndex c : out) link(c);
}

std::optional<std::array<Triangle, 2>> GapMesh::boundary_triangles(KeptIndex kept, int i) const {
  if (has_partner(kept, i)) return std::nullopt;
  const Quad quad = mesh_.cell(kept_[kept].source).quad(i);
  for (const int diagonal : {0, 1})
    if (tags_.cover_of(quad, diagonal)) return triangles_of(quad, diagonal);
  return std::nullopt;
}

bool GapMesh::has_partner(KeptIndex kept, int i) const {
  return mesh_.partner_at(kept_[kept].source, i) != no_index;
}

void GapMesh::set_alive(KeptIndex kept, bool is_alive) {
  kept_[kept].is_alive = is_alive;
  for (const Vertex v : kept_[kept].vertices()) {
    hold_if_kept(v);
    ++age_[v];
  }
}

void GapMesh::merge_kept(Vertex from, Vertex into) {
  for (const KeptIndex k : kept_at_[from]) {
    KeptCell& cell = kept_[k];
    for (const Vertex v : cell.vertices()) ++age_[v];
    std::ranges::replace(cell.corners, from, into);
    cell.has_changed = true;
    if (!kept_centres_.empty()) kept_centres_[k].reset();
    kept_at_[into].push_back(k);
  }
  ++age_[into];
  kept_at_[from].clear();
  holds_[from] = 0;
  hold_if_kept(into);
}

void GapMesh::add_kept(const KeptCell& cell) {
  const KeptIndex k(kept_.size());
  kept_.push_back(cell);
  kept_[k].has_changed = true;
  if (!kept_centres_.empty()) kept_centres_.emplace_back();
  for (const Vertex v : cell.vertices()) {
    kept_at_[v].push_back(k);
    holds_[v] |= of_kept;
    ++age_[v];
  }
}

void GapMesh::hold_if_kept(Vertex v) {
  if (kept_at(v).empty())
    holds_[v] &= static_cast<std::uint8_t>(~of_kept);
  else
    holds_[v] |= of_kept;
}

Vertex GapMesh::add_vertex(const Vec3& at) {
  at_.emplace_back();
  age_.push_back(0);
  holds_.push_back(0);
  return mesh_.add_point(at);
}

void GapMesh::relocate(Vertex v, const Vec3& to) {
  if (mesh_.points[v] == to) return;
  mesh_.points[v] = to;
  for (const KeptIndex c : kept_at_of(v)) {
    if (!kept_centres_.empty()) kept_centres_[c].reset();
    for (const Vertex w : kept_[c].vertices()) ++age_[w];
  }
  for (const GapIndex c : at_[v]) {
    if (static_cast<std::size_t>(c) < centres_.size()) centres_[c].reset();
    cells_[c].quality = quality_of(cells_[c].kind, mesh_.points, cells_[c].vertices());
    for (const Vertex w : cells_[c].vertices()) ++age_[w];
  }
}

std::vector<Vertex> GapMesh::inner_vertices_of(GapIndex c) const {
  std::vector<Vertex> inner;
  std::ranges::copy_if(cells_[c].vertices(), std::back_inserter(inner), [&](Vertex v) { return is_inside(v); });
  return inner;
}

std::vector<Vertex> GapMesh::inner_vertices_around(GapIndex c) const {
  std::vector<Vertex> inner;
  for (const Vertex v : cells_[c].vertices())
    for (const GapIndex other : at_[v])
      std::ranges::copy_if(cells_[other].vertices(), std::back_inserter(inner), [&](Vertex w) { return is_inside(w); });
  sort_unique(inner);
  return inner;
}

void GapMesh::write_back() {
  for (const KeptCell& cell : kept_)
    if ((!cell.is_alive || cell.has_changed) && cell.source != no_index && mesh_.cell(cell.source).alive)
      mesh_.remove_cell(cell.source);
  for (const auto c : indices<GapIndex>(cells_.size())) {
    if (alive_[c] != 0 || source_[c] == no_index) continue;
    if (cells_[c].kind == CellKind::tet)
      mesh_.remove_tet(TetIndex(source_[c]));
    else
      mesh_.remove_cell(CellIndex(source_[c]));
    source_[c] = no_index;
  }
  for (KeptCell& cell : kept_) {
    if (!cell.is_alive || !cell.has_changed) continue;
    hybrid::HybridCell changed;
    if (cell.source != no_index) changed = mesh_.cell(cell.source);
    changed.alive = true;
    changed.kind = cell.kind;
    changed.corners = cell.corners;
    changed.region = cell.region;
    cell.source = mesh_.add_cell(changed);
    cell.has_changed = false;
  }
  for (const auto c : indices<GapIndex>(cells_.size())) {
    if (alive_[c] == 0 || source_[c] != no_index) continue;
    const GapCell& cell = cells_[c];
    if (cell.kind == CellKind::tet) {
      source_[c] = mesh_.add_tet({cell.corners[0], cell.corners[1], cell.corners[2], cell.corners[3]}, cell.region);
      continue;
    }
    hybrid::HybridCell made;
    made.kind = cell.kind;
    made.corners.fill(no_index);
    std::ranges::copy(cell.vertices(), made.corners.begin());
    made.region = cell.region;
    source_[c] = mesh_.add_cell(made);
  }
}

}  // namespace hexpipe::assemble::gap
