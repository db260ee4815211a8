#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <span>

#include "tools/assemble/pieces/pieces.hpp"

namespace hexpipe::assemble::pieces {
namespace {

// The greatest number that is neither among these nor `but`.
std::int32_t unused_tag(std::span<const std::int32_t> used, std::int32_t but) {
  std::int32_t tag = std::numeric_limits<std::int32_t>::max();
  while (tag == but || std::ranges::find(used, tag) != used.end()) --tag;
  return tag;
}

class Cutter {
 public:
  Cutter(const PartView& view, const TetAdjacency& adjacency, const hybrid::SurfaceTags& tags, const Pieces& pieces)
      : view_(view), adjacency_(adjacency), tags_(tags), pieces_(pieces), tet_place_(view.mesh.tets.size(), no_index) {
    result_.seam.guest_region = unused_tag(view.mesh.tet_tags, 0);
    result_.seam.seam_tag = unused_tag(view.mesh.triangle_tags, 0);
    result_.seam.guest_tag = unused_tag(view.mesh.triangle_tags, result_.seam.seam_tag);
  }

  PieceInput cut(const SeamCells& cells) {
    take_tets(cells.guests);
    take_triangles();
    take_points();
    std::ranges::merge(cells.own, cells.guests, std::back_inserter(result_.view_cells));
    for (const CandidateIndex i : result_.view_cells) take_cell(i);
    return std::move(result_);
  }

 private:
  bool is_here(TetIndex tet) const { return pieces_.of_tet[tet] == view_.part.part; }

  void take_tets(const std::vector<CandidateIndex>& guests) {
    std::vector<std::uint8_t> taken(view_.mesh.tets.size());
    for (const auto t : indices<TetIndex>(taken.size())) taken[t] = is_here(t) ? 1 : 0;
    for (const CandidateIndex i : guests) {
      for (const TetIndex t : view_.cells.interior_tets_of(i)) taken[t] = 2;
      for (const TetIndex t : view_.cells.boundary_tets_of(i))
        if (pieces_.of_tet[t] == view_.keys.part[i]) taken[t] = 2;
    }
    for (const auto t : indices<TetIndex>(taken.size())) {
      if (taken[t] == 0) continue;
      tet_place_[t] = TetIndex(result_.mesh.tets.size());
      result_.mesh.tets.push_back(view_.mesh.tets[t]);
      result_.mesh.tet_tags.push_back(taken[t] == 1 ? view_.mesh.tet_tags[t] : result_.seam.guest_region);
    }
  }

  // Takes the view's tagged triangles in their order, then those where the piece or the guests end. The lower one of
  // two pieces keeps the tag of a triangle between them.
  void take_triangles() {
    std::vector<std::int32_t> new_tags(view_.mesh.triangles.size());
    std::vector<std::uint8_t> used(view_.mesh.triangles.size());
    std::vector<Triangle> ends;
    std::vector<std::int32_t> end_tags;
    for (const auto t : indices<TetIndex>(tet_place_.size())) {
      if (tet_place_[t] == no_index) continue;
      for (int i = 0; i < 4; ++i) {
        const TetIndex beyond = adjacency_.tet_beyond(t, i);
        const auto& corners = TetTopology::triangles[i];
        const Tet& tet = view_.mesh.tets[t];
        const Triangle facet{tet[corners[0]], tet[corners[1]], tet[corners[2]]};
        const auto tagged = tags_.find(facet);
        // If one of the two tets at a facet is the piece's own, that one decides its tag.
        if (!is_here(t) && beyond != no_index && is_here(beyond)) continue;
        const std::int32_t tag = tag_of(t, beyond, tagged);
        if (tagged) {
          used[*tagged] = 1;
          new_tags[*tagged] = tag;
        } else if (tag != inside_) {
          ends.push_back(facet);
          end_tags.push_back(tag);
        }
      }
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (used[i] == 0) continue;
      result_.mesh.triangles.push_back(view_.mesh.triangles[i]);
      result_.mesh.triangle_tags.push_back(new_tags[i]);
    }
    std::ranges::copy(ends, std::back_inserter(result_.mesh.triangles));
    std::ranges::copy(end_tags, std::back_inserter(result_.mesh.triangle_tags));
  }

  // The tag of a facet of tet `t`, which the piece or a guest has.
  std::int32_t tag_of(TetIndex t, TetIndex beyond, const std::optional<hybrid::TaggedTriangle>& tagged) const {
    const hybrid::Seam& seam = result_.seam;
    const bool ends = beyond != no_index && pieces_.of_tet[beyond] != view_.part.part;
    if (!is_here(t)) {
      const bool between_guests = beyond != no_index && tet_place_[beyond] != no_index;
      return between_guests && !tagged ? inside_ : seam.guest_tag;
    }
    if (ends && (!tagged || pieces_.of_tet[beyond] < view_.part.part)) return seam.seam_tag;
    return tagged ? view_.mesh.triangle_tags[*tagged] : inside_;
  }

  void take_points() {
    std::vector<Vertex> place(view_.mesh.points.size(), no_index);
    for (const Tet& tet : result_.mesh.tets)
      for (const Vertex v : tet) place[v] = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
      if (place[v] == no_index) continue;
      place[v] = static_cast<Vertex>(result_.mesh.points.size());
      result_.mesh.points.push_back(view_.mesh.points[v]);
      result_.point_number.push_back(view_.part.point_number[v]);
      const bool is_shared =
          !std::ranges::all_of(adjacency_.tets_at(static_cast<Vertex>(v)), [&](TetIndex t) { return is_here(t); });
      result_.seam.is_shared.push_back(is_shared ? 1 : 0);
    }
    for (Tet& tet : result_.mesh.tets)
      for (Vertex& v : tet) v = place[v];
    for (Triangle& triangle : result_.mesh.triangles)
      for (Vertex& v : triangle) v = place[v];
    point_place_ = std::move(place);
  }

  void take_cell(CandidateIndex i) {
    append_candidate(
        result_.cells, view_.cells, i, [&](Vertex v) { return point_place_[v]; },
        [&](TetIndex t) { return tet_place_[t]; },
        [&](TetIndex t) { return pieces_.of_tet[t] == view_.keys.part[i] ? tet_place_[t] : no_index; });
    result_.seam.is_guest.push_back(view_.keys.part[i] != view_.part.part ? 1 : 0);
  }

  // Stands for a facet that is no tagged triangle.
  const std::int32_t inside_ = std::numeric_limits<std::int32_t>::min();

  const PartView& view_;
  const TetAdjacency& adjacency_;
  const hybrid::SurfaceTags& tags_;
  const Pieces& pieces_;
  PieceInput result_;
  std::vector<TetIndex> tet_place_;
  std::vector<Vertex> point_place_;
};

}  // namespace

PieceInput cut_piece(const PartView& view, const TetAdjacency& adjacency, const hybrid::SurfaceTags& tags,
                     const Pieces& pieces, const SeamCells& cells) {
  return Cutter(view, adjacency, tags, pieces).cut(cells);
}

}  // namespace hexpipe::assemble::pieces
