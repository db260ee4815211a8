// At a vertex of a wall, cells that share a facet which is no wall belong to one wedge. A vertex on a smooth wall has
// one wedge, or two if the wall has cells on both sides; where walls only touch, there are more.

#include "tools/assemble/layers/walls.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/joined_sets.hpp"
#include "tools/assemble/hybrid/cell_facets.hpp"

namespace hexpipe::assemble::layers {
namespace {

using hybrid::FacetForm;

// Numbers of the blocks of a mesh.
enum Block : std::int32_t { hexes, prisms, pyramids, tets, triangles, quads };

// Calls visit(block number, block) for the cells, or the tagged facets.
template <class Visit>
void for_each_cell_block(auto& mesh, Visit&& visit) {
  visit(Block::hexes, CellKind::hex, mesh.hexes);
  visit(Block::prisms, CellKind::prism, mesh.prisms);
  visit(Block::pyramids, CellKind::pyramid, mesh.pyramids);
  visit(Block::tets, CellKind::tet, mesh.tets);
}
template <class Visit>
void for_each_facet_block(auto& mesh, Visit&& visit) {
  visit(Block::triangles, mesh.triangles);
  visit(Block::quads, mesh.quads);
}

Vertex& corner_of(MixedMesh& mesh, std::int32_t block, std::int32_t cell, std::int32_t corner) {
  switch (block) {
    case Block::hexes:
      return mesh.hexes.cells[cell][corner];
    case Block::prisms:
      return mesh.prisms.cells[cell][corner];
    case Block::pyramids:
      return mesh.pyramids.cells[cell][corner];
    case Block::tets:
      return mesh.tets.cells[cell][corner];
    case Block::triangles:
      return mesh.triangles.cells[cell][corner];
    default:
      return mesh.quads.cells[cell][corner];
  }
}

// A cell beside the walls.
struct NearCell {
  std::int32_t block, index;
  std::int32_t region;
  std::vector<std::pair<Vertex, std::int32_t>> corners;  // those on walls, and their places in the cell
  std::vector<std::int32_t> wedges;                      // by corner in `corners`

  std::int32_t wedge_at(Vertex v) const {
    const auto found = std::ranges::find(corners, v, &std::pair<Vertex, std::int32_t>::first);
    return wedges[found - corners.begin()];
  }
};

// A facet of a cell that has a vertex on a wall.
struct NearFacet {
  FacetVertices form;
  std::int32_t cell;  // among those near
  Quad corners;       // outwards
};

struct TaggedFacet {
  FacetVertices form;
  std::int32_t block, index, tag;
  const WallGroup* group;  // nullptr: no wall
  int layers;              // 0: neither a wall nor a facet over which layers run out

  bool has_sides() const { return layers > 0; }
};

Vec3 corner_normal(const MixedMesh& mesh, const Quad& facet, int size, int corner) {
  const Vec3& at = mesh.points[facet[corner]];
  return unit(cross(mesh.points[facet[(corner + 1) % size]] - at, mesh.points[facet[(corner + size - 1) % size]] - at));
}

Vec3 corner_bisector(const MixedMesh& mesh, const Quad& facet, int size, int corner) {
  const Vec3& at = mesh.points[facet[corner]];
  return unit(mesh.points[facet[(corner + 1) % size]] - at) + unit(mesh.points[facet[(corner + size - 1) % size]] - at);
}

class WallFinder {
 public:
  WallFinder(const MixedMesh& mesh, std::span<const WallGroup> groups, std::span<const RunOut> run_outs)
      : mesh_(mesh), groups_(groups), run_outs_(run_outs) {
    find_tagged_facets();
    find_cells();
    find_facets();
    join_wedges();
  }

  std::vector<WallSide> sides;
  std::vector<Line> lines;
  std::vector<LineEdge> edges;

  // Calls use(block, cell, corner, line) for each corner that goes to the tip of a line.
  template <class Use>
  void for_each_use(Use&& use) {
    for (const NearCell& cell : cells_)
      for (std::size_t i = 0; i < cell.corners.size(); ++i)
        if (const LineIndex line = line_at(cell.wedges[i]); line != no_index)
          use(cell.block, cell.index, cell.corners[i].second, line);
    for (const auto& [facet, of_cell, is_outer] : guides_)
      for (int i = 0; i < size_of(facet->form); ++i)
        if (const LineIndex line = line_of(of_cell->cell, vertex_of(*facet, i)); line != no_index)
          use(facet->block, facet->index, i, line);
  }

  void find_sides();
  void find_edges();

 private:
  static int size_of(const FacetVertices& form) { return form[3] == no_index ? 3 : 4; }
  Vertex vertex_of(const TaggedFacet& facet, int i) const {
    return facet.block == Block::quads ? mesh_.quads.cells[facet.index][i] : mesh_.triangles.cells[facet.index][i];
  }
  bool is_on_wall(Vertex v) const { return is_on_wall_[v] != 0; }
  LineIndex line_at(std::int32_t wedge) { return line_of_wedge_[sets_.of(wedge)]; }
  LineIndex line_of(std::int32_t cell, Vertex v) {
    return is_on_wall(v) ? line_at(cells_[cell].wedge_at(v)) : no_index;
  }
  const TaggedFacet* find_tagged(const FacetVertices& form) const {
    const auto found = std::ranges::lower_bound(tagged_, form, {}, &TaggedFacet::form);
    return found != tagged_.end() && found->form == form ? &*found : nullptr;
  }
  // Calls visit(facets of one form, tagged facet or nullptr).
  template <class Visit>
  void for_each_form(Visit&& visit) const {
    for (std::size_t i = 0, next = 0; i < facets_.size(); i = next) {
      while (next < facets_.size() && facets_[next].form == facets_[i].form) ++next;
      visit(std::span(facets_).subspan(i, next - i), find_tagged(facets_[i].form));
    }
  }
  int layers_beyond_rim(const FacetVertices& form) const;
  void find_tagged_facets();
  void find_cells();
  void find_facets();
  void join_wedges();
  void add_side(const NearFacet& facet, const TaggedFacet& tagged);

  const MixedMesh& mesh_;
  std::span<const WallGroup> groups_;
  std::span<const RunOut> run_outs_;
  std::vector<std::uint8_t> is_on_wall_;
  std::vector<TaggedFacet> tagged_;  // by form
  std::vector<NearCell> cells_;
  std::vector<NearFacet> facets_;  // by form
  JoinedSets sets_;                // of wedges
  std::vector<LineIndex> line_of_wedge_;
  struct GuideFacet {
    const TaggedFacet* facet;
    const NearFacet* of_cell;  // as a cell has it
    bool is_outer;             // the only one
  };
  std::vector<GuideFacet> guides_;  // tagged facets that have no sides
};

int WallFinder::layers_beyond_rim(const FacetVertices& form) const {
  const auto found = std::ranges::lower_bound(run_outs_, form, {}, &RunOut::facet);
  return found != run_outs_.end() && found->facet == form ? found->layers : 0;
}

void WallFinder::find_tagged_facets() {
  is_on_wall_.assign(mesh_.points.size(), 0);
  for_each_facet_block(mesh_, [&](std::int32_t number, const auto& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      const auto group = std::ranges::lower_bound(groups_, block.tags[i], {}, &WallGroup::tag);
      const WallGroup* wall = group == groups_.end() || group->tag != block.tags[i] ? nullptr : &*group;
      const FacetVertices form = FacetForm::of(block.cells[i]).vertices;
      const int layers = wall != nullptr ? wall->layers : layers_beyond_rim(form);
      tagged_.push_back({form, number, static_cast<std::int32_t>(i), block.tags[i], wall, layers});
      if (layers == 0) continue;
      for (const Vertex v : block.cells[i]) is_on_wall_[v] = 1;
    }
  });
  std::ranges::sort(tagged_, {}, &TaggedFacet::form);
}

void WallFinder::find_cells() {
  std::int32_t wedges = 0;
  for_each_cell_block(mesh_, [&](std::int32_t number, CellKind, const auto& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      NearCell cell{number, static_cast<std::int32_t>(i), block.tags[i], {}, {}};
      for (std::size_t k = 0; k < block.cells[i].size(); ++k) {
        if (!is_on_wall(block.cells[i][k])) continue;
        cell.corners.emplace_back(block.cells[i][k], static_cast<std::int32_t>(k));
        cell.wedges.push_back(wedges++);
      }
      if (!cell.corners.empty()) cells_.push_back(std::move(cell));
    }
  });
  sets_ = JoinedSets(static_cast<std::size_t>(wedges));
  line_of_wedge_.assign(static_cast<std::size_t>(wedges), no_index);
}

void WallFinder::find_facets() {
  const auto add = [&](std::int32_t cell, const Quad& corners, int size) {
    const auto used = std::span(corners).first(size);
    if (std::ranges::any_of(used, [&](Vertex v) { return is_on_wall(v); }))
      facets_.push_back({FacetForm::of(used).vertices, cell, corners});
  };
  std::size_t next = 0;
  for_each_cell_block(mesh_, [&](std::int32_t number, CellKind kind, const auto& block) {
    for (; next < cells_.size() && cells_[next].block == number; ++next) {
      const auto& c = block.cells[cells_[next].index];
      with_topology(kind, [&](auto topology) {
        if constexpr (decltype(topology)::corner_count == std::tuple_size_v<std::decay_t<decltype(c)>>) {
          for (const auto& t : decltype(topology)::triangles)
            add(static_cast<std::int32_t>(next), {c[t[0]], c[t[1]], c[t[2]], no_index}, 3);
          for (const auto& q : decltype(topology)::quads)
            add(static_cast<std::int32_t>(next), {c[q[0]], c[q[1]], c[q[2]], c[q[3]]}, 4);
        }
      });
    }
  });
  std::ranges::sort(facets_, {}, [](const NearFacet& f) { return std::tie(f.form, f.cell); });
}

void WallFinder::join_wedges() {
  for_each_form([&](std::span<const NearFacet> both, const TaggedFacet* tagged) {
    if (tagged != nullptr && !tagged->has_sides()) guides_.push_back({tagged, &both[0], both.size() == 1});
    if (both.size() < 2 || (tagged != nullptr && tagged->has_sides())) return;
    for (const Vertex v : both[0].corners)
      if (v != no_index && is_on_wall(v))
        sets_.join(cells_[both[0].cell].wedge_at(v), cells_[both[1].cell].wedge_at(v));
  });
}

void WallFinder::add_side(const NearFacet& facet, const TaggedFacet& tagged) {
  const NearCell& cell = cells_[facet.cell];
  WallSide side{facet.corners, {no_index, no_index, no_index, no_index},
                tagged.tag,    cell.region,
                tagged.layers, tagged.group == nullptr};
  for (int i = 0; i < side.size(); ++i) {
    LineIndex& line = line_of_wedge_[sets_.of(cell.wedge_at(side.corners[i]))];
    if (line == no_index) {
      line = LineIndex(lines.size());
      lines.emplace_back().foot = side.corners[i];
    }
    side.lines[i] = line;
    lines[line].layers = std::max(lines[line].layers, side.layers);
    lines[line].is_on_wall = lines[line].is_on_wall || !side.is_run_out;
    // Quads may be warped: the line has to see them at all corners.
    for (int k = 0; k < side.size(); ++k)
      lines[line].normals.push_back(-corner_normal(mesh_, side.corners, side.size(), k));
  }
  sides.push_back(side);
}

void WallFinder::find_sides() {
  const auto has_layers = [&](const NearFacet& facet, const TaggedFacet& tagged) {
    if (tagged.group == nullptr) return true;
    const auto& regions = tagged.group->regions;
    return regions.empty() || std::ranges::find(regions, cells_[facet.cell].region) != regions.end();
  };
  for_each_form([&](std::span<const NearFacet> both, const TaggedFacet* tagged) {
    if (tagged == nullptr || !tagged->has_sides()) return;
    for (const NearFacet& facet : both)
      if (has_layers(facet, *tagged)) add_side(facet, *tagged);
  });
  // A line cannot leave the bare side of a wall.
  for_each_form([&](std::span<const NearFacet> both, const TaggedFacet* tagged) {
    if (tagged == nullptr || !tagged->has_sides()) return;
    for (const NearFacet& facet : both) {
      if (has_layers(facet, *tagged)) continue;
      const int size = facet.corners[3] == no_index ? 3 : 4;
      for (int i = 0; i < size; ++i)
        if (const LineIndex line = line_of(facet.cell, facet.corners[i]); line != no_index)
          lines[line].normals.push_back(-corner_normal(mesh_, facet.corners, size, i));
    }
  });
}

void WallFinder::find_edges() {
  std::map<std::array<LineIndex, 2>, LineEdge> found;
  const auto edge_at = [&](LineIndex a, LineIndex b) -> LineEdge& {
    LineEdge& edge = found[{std::min(a, b), std::max(a, b)}];
    edge.lines = {std::min(a, b), std::max(a, b)};
    return edge;
  };
  for (const WallSide& side : sides)
    for (int i = 0; i < side.size(); ++i) ++edge_at(side.lines[i], side.lines[(i + 1) % side.size()]).sides;
  for (const auto& [facet, of_cell, is_outer] : guides_) {
    const int size = size_of(facet->form);
    const Quad& corners = of_cell->corners;
    const auto line_at_corner = [&](int i) { return line_of(of_cell->cell, corners[i % size]); };
    for (int i = 0; i < size; ++i) {
      const LineIndex line = line_at_corner(i), next = line_at_corner(i + 1);
      if (line == no_index) continue;
      lines[line].guides.push_back({corner_normal(mesh_, corners, size, i), corner_bisector(mesh_, corners, size, i),
                                    facet->tag, facet->form, is_outer});
      if (next == no_index) continue;
      const auto edge = found.find({std::min(line, next), std::max(line, next)});
      // Where the walls end at the boundary, interfaces that end there, too, do not count.
      if (edge == found.end() || (edge->second.is_tagged && (!is_outer || edge->second.is_outer))) continue;
      edge->second.tag = facet->tag;
      edge->second.is_tagged = true;
      edge->second.is_outer = is_outer;
    }
  }
  for (auto& [key, edge] : found) edges.push_back(edge);
}

}  // namespace

Walls::Walls(const MixedMesh& mesh, std::span<const WallGroup> groups, std::span<const RunOut> run_outs) {
  WallFinder finder(mesh, groups, run_outs);
  finder.find_sides();
  finder.find_edges();
  finder.for_each_use([&](std::int32_t block, std::int32_t cell, std::int32_t corner, LineIndex line) {
    uses_.push_back({block, cell, corner, line});
  });
  sides_ = std::move(finder.sides);
  lines_ = std::move(finder.lines);
  edges_ = std::move(finder.edges);
}

const LineEdge& Walls::edge(LineIndex a, LineIndex b) const {
  const std::array<LineIndex, 2> key{std::min(a, b), std::max(a, b)};
  return *std::ranges::lower_bound(edges_, key, {}, &LineEdge::lines);
}

void Walls::split(MixedMesh& mesh, std::span<const std::uint8_t> grows) {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (grows[i] == 0) continue;
    lines_[i].tip = static_cast<Vertex>(mesh.points.size());
    mesh.points.push_back(mesh.points[lines_[i].foot]);
  }
  for (const Use& use : uses_)
    if (const Vertex tip = lines_[use.line].tip; tip != no_index)
      corner_of(mesh, use.block, use.cell, use.corner) = tip;
}

}  // namespace hexpipe::assemble::layers
