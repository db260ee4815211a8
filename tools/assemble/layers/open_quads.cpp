#include "tools/assemble/layers/open_quads.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "tools/assemble/hybrid/cell_facets.hpp"

namespace hexpipe::assemble::layers {
namespace {

using hybrid::FacetForm;

// The diagonal along which the quad should be cut; nothing if it can stay. It leaves out a single line without length,
// or a single one that has a length, so that the other triangle has three alike.
std::optional<VertexKey<2>> cut_of(const WallSide& side, std::span<const std::uint8_t> grows) {
  if (side.size() == 3) return std::nullopt;
  int count = 0;
  for (const LineIndex line : side.lines) count += grows[line];
  const auto diagonal = [&](int i) { return edge_key(side.corners[i % 4], side.corners[(i + 2) % 4]); };
  if (count == 1 || count == 3) {
    const std::uint8_t single = count == 1;
    const auto alone = std::ranges::find_if(side.lines, [&](LineIndex line) { return grows[line] == single; });
    return diagonal(static_cast<int>(alone - side.lines.begin()) + 1);
  }
  if (count == 2 && grows[side.lines[0]] == grows[side.lines[2]]) return diagonal(grows[side.lines[0]] != 0 ? 0 : 1);
  return std::nullopt;
}

// The cells that take the place of one.
struct Pieces {
  std::vector<std::array<Vertex, 5>> pyramids;
  std::vector<Tet> tets;
};

class Opener {
 public:
  Opener(MixedMesh& mesh, std::vector<Vertex>& origin)
      : mesh_(mesh), origin_(origin), next_origin_(*std::ranges::max_element(origin) + 1) {}

  void add_cut(const WallSide& side, const VertexKey<2>& diagonal) {
    cuts_.try_emplace(FacetForm::of(side.corners).vertices, diagonal);
  }
  bool run();

 private:
  const VertexKey<2>* cut_at(const Quad& quad) const {
    const auto found = cuts_.find(FacetForm::of(quad).vertices);
    return found == cuts_.end() ? nullptr : &found->second;
  }
  static std::array<Triangle, 2> halves(const Quad& quad, const VertexKey<2>& diagonal) {
    return triangles_of(quad, edge_key(quad[0], quad[2]) == diagonal ? 0 : 1);
  }
  Pieces pieces_of(CellKind kind, std::span<const Vertex> corners, Vertex centre) const;
  bool are_valid(const Pieces& pieces, const Vec3& centre) const;
  // Takes back the cuts of cells that cannot be opened. False if there are none.
  bool take_back();
  template <int Corners>
  void open(CellKind kind, CellBlock<Corners>& block);

  MixedMesh& mesh_;
  std::vector<Vertex>& origin_;
  Vertex next_origin_;  // a number that no point has yet
  std::map<FacetVertices, VertexKey<2>> cuts_;
  CellBlock<5> pyramids_;
  CellBlock<4> tets_;
};

// Calls visit(quad) for each quad of a cell, outwards.
template <class Visit>
void for_each_quad(CellKind kind, std::span<const Vertex> corners, Visit&& visit) {
  with_topology(kind, [&](auto topology) {
    for (const auto& q : decltype(topology)::quads)
      visit(Quad{corners[q[0]], corners[q[1]], corners[q[2]], corners[q[3]]});
  });
}

Vec3 middle_of(std::span<const Vec3> points, std::span<const Vertex> corners) {
  Vec3 middle{};
  for (const Vertex v : corners) middle += points[v] * (1.0 / static_cast<double>(corners.size()));
  return middle;
}

Pieces Opener::pieces_of(CellKind kind, std::span<const Vertex> corners, Vertex centre) const {
  Pieces pieces;
  const Vertex apex = kind == CellKind::pyramid ? corners[4] : centre;
  const auto add_tet = [&](const Triangle& t) { pieces.tets.push_back({t[0], t[2], t[1], apex}); };
  for_each_quad(kind, corners, [&](const Quad& quad) {
    if (const VertexKey<2>* cut = cut_at(quad))
      for (const Triangle& half : halves(quad, *cut)) add_tet(half);
    else
      pieces.pyramids.push_back({quad[0], quad[3], quad[2], quad[1], apex});
  });
  if (kind != CellKind::pyramid)
    with_topology(kind, [&](auto topology) {
      for (const auto& t : decltype(topology)::triangles) add_tet({corners[t[0]], corners[t[1]], corners[t[2]]});
    });
  return pieces;
}

// Vertices beyond the mesh's points are at `centre`.
bool Opener::are_valid(const Pieces& pieces, const Vec3& centre) const {
  const auto is_valid_piece = [&](CellKind kind, std::span<const Vertex> corners) {
    std::array<Vec3, 8> at;
    for (std::size_t i = 0; i < corners.size(); ++i)
      at[i] = corners[i] < static_cast<Vertex>(mesh_.points.size()) ? mesh_.points[corners[i]] : centre;
    return is_valid(kind, std::span<const Vec3>(at).first(corners.size()));
  };
  return std::ranges::all_of(pieces.pyramids, [&](const auto& p) { return is_valid_piece(CellKind::pyramid, p); }) &&
         std::ranges::all_of(pieces.tets, [&](const auto& t) { return is_valid_piece(CellKind::tet, t); });
}

bool Opener::take_back() {
  std::vector<FacetVertices> failed;
  hybrid::for_each_cell(mesh_, [&](CellKind kind, std::span<const Vertex> corners, std::int32_t) {
    std::vector<FacetVertices> cut;
    for_each_quad(kind, corners, [&](const Quad& quad) {
      if (cut_at(quad) != nullptr) cut.push_back(FacetForm::of(quad).vertices);
    });
    if (cut.empty()) return;
    const Pieces pieces = pieces_of(kind, corners, static_cast<Vertex>(mesh_.points.size()));
    if (!are_valid(pieces, middle_of(mesh_.points, corners))) failed.insert(failed.end(), cut.begin(), cut.end());
  });
  for (const FacetVertices& form : failed) cuts_.erase(form);
  return !failed.empty();
}

template <int Corners>
void Opener::open(CellKind kind, CellBlock<Corners>& block) {
  CellBlock<Corners> kept;
  for (std::size_t i = 0; i < block.size(); ++i) {
    const std::array<Vertex, Corners> corners = block.cells[i];
    bool is_cut = false;
    for_each_quad(kind, corners, [&](const Quad& quad) { is_cut = is_cut || cut_at(quad) != nullptr; });
    if (!is_cut) {
      kept.cells.push_back(corners);
      kept.tags.push_back(block.tags[i]);
      continue;
    }
    const auto centre = static_cast<Vertex>(mesh_.points.size());
    const Pieces pieces = pieces_of(kind, corners, centre);
    if (kind != CellKind::pyramid) {
      mesh_.points.push_back(middle_of(mesh_.points, corners));
      origin_.push_back(next_origin_++);
    }
    for (const auto& pyramid : pieces.pyramids)
      pyramids_.cells.push_back(pyramid), pyramids_.tags.push_back(block.tags[i]);
    for (const auto& tet : pieces.tets) tets_.cells.push_back(tet), tets_.tags.push_back(block.tags[i]);
  }
  block = std::move(kept);
}

template <int Corners>
void append(const CellBlock<Corners>& from, CellBlock<Corners>& to) {
  to.quality.clear();
  to.cells.insert(to.cells.end(), from.cells.begin(), from.cells.end());
  to.tags.insert(to.tags.end(), from.tags.begin(), from.tags.end());
}

bool Opener::run() {
  while (!cuts_.empty() && take_back()) continue;
  if (cuts_.empty()) return false;
  open(CellKind::hex, mesh_.hexes);
  open(CellKind::prism, mesh_.prisms);
  open(CellKind::pyramid, mesh_.pyramids);
  append(pyramids_, mesh_.pyramids);
  append(tets_, mesh_.tets);
  CellBlock<4> quads;
  for (std::size_t i = 0; i < mesh_.quads.size(); ++i) {
    const Quad& quad = mesh_.quads.cells[i];
    const std::int32_t tag = mesh_.quads.tags[i];
    if (const VertexKey<2>* cut = cut_at(quad)) {
      for (const Triangle& half : halves(quad, *cut))
        mesh_.triangles.cells.push_back(half), mesh_.triangles.tags.push_back(tag);
    } else {
      quads.cells.push_back(quad), quads.tags.push_back(tag);
    }
  }
  mesh_.quads = std::move(quads);
  return true;
}

}  // namespace

bool open_quads(MixedMesh& mesh, std::vector<Vertex>& origin, const Walls& walls, std::span<const std::uint8_t> grows) {
  Opener opener(mesh, origin);
  for (const WallSide& side : walls.sides())
    if (const auto diagonal = cut_of(side, grows)) opener.add_cut(side, *diagonal);
  return opener.run();
}

}  // namespace hexpipe::assemble::layers
