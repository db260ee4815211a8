// A row of hexes that ends inside ends at a column of prisms. Where the column moves over by a hex from one layer to
// the next, ten to fourteen pyramids and tets stand between the layers, and six to eight where it turns. A column goes
// when the vertices of one of its three sides merge, pair by pair: its prisms vanish, the hexes behind them become the
// new column, and the row is one hex shorter. Where the new column meets the next one, what stood between them goes,
// too.

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "common/mesh/item_lists.hpp"
#include "tools/assemble/gap/merge_on_surface.hpp"
#include "tools/assemble/gap/passes.hpp"
#include "tools/assemble/gap/reshape.hpp"

namespace hexpipe::assemble::gap {
namespace {

constexpr int most_passes = 6;
// The time for a column grows with the square of its length.
constexpr std::size_t most_levels = 200;
// Surfaces at the two ends of a column.
constexpr std::size_t most_pairs_on_surface = 2;

using Pair = std::array<Vertex, 2>;
using Level = std::array<Vertex, 3>;

// Prisms that stand on each other, and the triangles between them.
struct Column {
  std::vector<Level> levels;
  std::vector<Piece> prisms;
};

class RowShortener {
 public:
  RowShortener(GapMesh& gap, hybrid::SurfaceTags& tags, const shape::InputSurface& surface)
      : gap_(gap), surface_(gap, tags, surface), reshaper_(gap) {}

  ShortenCounts run(bool chosen_may_go) {
    for (int pass = 0; pass < most_passes; ++pass) {
      const ShortenCounts before = counts_;
      refill_rooms();
      if (chosen_may_go) shorten_rows(), close_pairs();
      if (counts_.rooms + counts_.rows + counts_.pairs == before.rooms + before.rows + before.pairs) break;
    }
    counts_.hexes = reshaper_.hexes_gone();
    return counts_;
  }

 private:
  void refill_rooms();
  void shorten_rows();
  void close_pairs();
  std::vector<Piece> prisms() const;
  bool is_present(const Piece& piece) const;
  std::optional<Piece> prism_on(const Level& triangle, const Piece& except) const;
  void climb(Level triangle, const Piece& from, Column& column) const;
  Column column_of(const Piece& prism) const;
  bool is_before_prism(const Column& column, std::size_t side) const;
  bool is_large(GapIndex c) const {
    return static_cast<std::size_t>(c) < is_large_.size() && is_large_[static_cast<std::size_t>(c)];
  }
  void mark_large(GapIndex c);
  std::optional<std::vector<SurfaceMerge>> merges_on_surface(std::span<const Pair> pairs) const;
  bool merge(std::span<const Pair> pairs);

  GapMesh& gap_;
  SurfaceMerger surface_;
  Reshaper reshaper_;
  ShortenCounts counts_;
  std::vector<bool> is_large_;  // by cell of the gap: part of a room that is too large
};

bool have_common_vertex(const Fan& one, const Fan& two) {
  const auto has = [&](Vertex v) {
    return std::ranges::any_of(two.triangles, [&](const Triangle& t) { return std::ranges::find(t, v) != t.end(); });
  };
  return std::ranges::any_of(one.triangles, [&](const Triangle& t) { return std::ranges::any_of(t, has); });
}

// Those on the surface; nothing if it does not allow them.
std::optional<std::vector<SurfaceMerge>> RowShortener::merges_on_surface(std::span<const Pair> pairs) const {
  std::vector<SurfaceMerge> merges;
  for (const auto& [a, b] : pairs) {
    if (gap_.is_at_seam(a) || gap_.is_at_seam(b)) return std::nullopt;
    if (gap_.is_inside(a) || gap_.is_inside(b)) continue;
    if (merges.size() == most_pairs_on_surface) return std::nullopt;
    auto merge = surface_.merge_of(a, b, [](Vertex, Vertex) { return true; });
    if (!merge) return std::nullopt;
    merges.push_back(std::move(*merge));
  }
  if (merges.size() == 2 && have_common_vertex(merges[0].fan, merges[1].fan)) return std::nullopt;
  return merges;
}

// In a ring of prisms each level comes twice.
bool are_distinct(std::span<const Pair> pairs) {
  std::vector<Vertex> vertices;
  for (const Pair& pair : pairs) vertices.insert(vertices.end(), pair.begin(), pair.end());
  sort_unique(vertices);
  return vertices.size() == 2 * pairs.size();
}

bool RowShortener::merge(std::span<const Pair> pairs) {
  if (!are_distinct(pairs)) return false;
  const auto on_surface = merges_on_surface(pairs);
  if (!on_surface) return false;
  std::vector<VertexMerge> merges;
  for (const auto& [a, b] : pairs)
    if (gap_.is_inside(a) || gap_.is_inside(b)) merges.push_back(merge_inside(gap_, a, b));
  for (const SurfaceMerge& merge : *on_surface) merges.push_back(merge.vertices);
  if (!reshaper_.merge(merges)) return false;
  for (const SurfaceMerge& merge : *on_surface) surface_.finish(merge);
  return true;
}

std::optional<Piece> RowShortener::prism_on(const Level& triangle, const Piece& except) const {
  for (const Piece& piece : pieces_at(gap_, triangle[0])) {
    if (piece.solid.kind != CellKind::prism || piece == except) continue;
    const std::span<const Vertex> corners = piece.solid.vertices();
    if (std::ranges::is_permutation(triangle, corners.first(3)) ||
        std::ranges::is_permutation(triangle, corners.last(3)))
      return piece;
  }
  return std::nullopt;
}

// Appends the prisms beyond a triangle of `from`.
void RowShortener::climb(Level triangle, const Piece& from, Column& column) const {
  for (auto next = prism_on(triangle, from); next; next = prism_on(triangle, column.prisms.back())) {
    if (*next == from) return;  // the prisms are a ring
    const auto& corners = next->solid.corners;
    for (Vertex& v : triangle) {
      const auto at = static_cast<std::size_t>(std::ranges::find(corners, v) - corners.begin());
      v = corners[(at + 3) % 6];
    }
    column.levels.push_back(triangle);
    column.prisms.push_back(*next);
  }
}

Column RowShortener::column_of(const Piece& prism) const {
  const auto& c = prism.solid.corners;
  const Level bottom{c[0], c[1], c[2]}, top{c[3], c[4], c[5]};
  Column column;
  climb(bottom, prism, column);
  std::ranges::reverse(column.levels);
  std::ranges::reverse(column.prisms);
  column.levels.insert(column.levels.end(), {bottom, top});
  column.prisms.push_back(prism);
  Column above;
  climb(top, prism, above);
  column.levels.insert(column.levels.end(), above.levels.begin(), above.levels.end());
  column.prisms.insert(column.prisms.end(), above.prisms.begin(), above.prisms.end());
  return column;
}

std::vector<Piece> RowShortener::prisms() const {
  std::vector<Piece> prisms;
  const auto take = [&](const Piece& piece) {
    if (piece.solid.kind == CellKind::prism) prisms.push_back(piece);
  };
  for (const auto c : indices<GapIndex>(gap_.cell_count()))
    if (gap_.is_alive(c)) take(piece_of(gap_, c));
  for (const auto k : indices<KeptIndex>(gap_.kept_count()))
    if (gap_.kept_cell(k).is_alive) take(piece_of(gap_, k));
  return prisms;
}

// Whether it is as it was.
bool RowShortener::is_present(const Piece& piece) const {
  if (piece.gap != no_index) return gap_.is_alive(piece.gap);
  const KeptCell& cell = gap_.kept_cell(piece.kept);
  return cell.is_alive && cell.kind == piece.solid.kind && cell.corners == piece.solid.corners;
}

// Where prisms stand side by side, no row ends: they were chosen as they are.
bool RowShortener::is_before_prism(const Column& column, std::size_t side) const {
  const Vertex a = column.levels[0][side], b = column.levels[0][(side + 1) % 3];
  const Vertex c = column.levels[1][side], d = column.levels[1][(side + 1) % 3];
  return std::ranges::any_of(pieces_at(gap_, a), [&](const Piece& piece) {
    return piece.solid.kind == CellKind::prism && !(piece == column.prisms.front()) && piece.has(b) && piece.has(c) &&
           piece.has(d);
  });
}

void RowShortener::shorten_rows() {
  std::vector<bool> seen_gap(gap_.cell_count()), seen_kept(gap_.kept_count());
  const auto is_seen = [&](const Piece& piece) {
    return piece.gap != no_index ? seen_gap[static_cast<std::size_t>(piece.gap)]
                                 : seen_kept[static_cast<std::size_t>(piece.kept)];
  };
  for (const Piece& prism : prisms()) {
    if (!is_present(prism) || is_seen(prism)) continue;
    const Column column = column_of(prism);
    seen_gap.resize(gap_.cell_count());
    for (const Piece& piece : column.prisms) is_seen(piece) = true;
    if (column.levels.size() > most_levels) continue;
    for (std::size_t side = 0; side < 3; ++side) {
      if (is_before_prism(column, side)) continue;
      std::vector<Pair> pairs;
      for (const Level& level : column.levels) pairs.push_back({level[side], level[(side + 1) % 3]});
      if (!merge(pairs)) continue;
      ++counts_.rows;
      counts_.vertices += static_cast<std::int64_t>(pairs.size());
      break;
    }
  }
}

// Marks a room that is too large, so that nobody grows it again. New cells are not marked.
void RowShortener::mark_large(GapIndex c) {
  std::vector<GapIndex> queue{c};
  is_large_.resize(gap_.cell_count());
  is_large_[static_cast<std::size_t>(c)] = true;
  while (!queue.empty()) {
    const GapIndex at = queue.back();
    queue.pop_back();
    for (const Vertex v : gap_.cell(at).vertices())
      for (const GapIndex other : gap_.cells_at(v)) {
        if (is_large(other) || gap_.cell(other).kind == CellKind::prism) continue;
        if (gap_.cell(at).count_common(gap_.cell(other)) < 3) continue;
        is_large_[static_cast<std::size_t>(other)] = true;
        queue.push_back(other);
      }
  }
}

// All tets and pyramids between the same chosen cells and prisms at once.
void RowShortener::refill_rooms() {
  std::vector<bool> seen(gap_.cell_count());
  std::vector<GapIndex> room;
  for (const auto c : indices<GapIndex>(seen.size())) {
    if (!gap_.is_alive(c) || gap_.cell(c).kind == CellKind::prism) continue;
    if (seen[static_cast<std::size_t>(c)] || is_large(c)) continue;
    const auto refilled = reshaper_.refill(c, room);
    counts_.rooms += refilled == Reshaper::Refilled::yes ? 1 : 0;
    if (refilled == Reshaper::Refilled::too_large) mark_large(c);
    for (const GapIndex other : room)
      if (static_cast<std::size_t>(other) < seen.size()) seen[static_cast<std::size_t>(other)] = true;
  }
}

// Vertices of chosen cells that an edge of the gap joins, as close_gaps() does, but with rooms of any size.
void RowShortener::close_pairs() {
  for (const auto& [a, b] : edges_across_gap(gap_)) {
    const auto has_b = [&, other = b](const Piece& piece) { return piece.has(other); };
    bool is_edge = false, may_close = true;
    for (const Piece& piece : pieces_at(gap_, a)) {
      if (!has_b(piece)) continue;
      is_edge = is_edge || piece.gap != no_index;
      may_close = may_close && piece.gap != no_index && !is_large(piece.gap);
    }
    if (!is_edge || !may_close) continue;
    const Pair pair{a, b};
    if (!merge(std::span(&pair, 1))) continue;
    ++counts_.pairs;
    ++counts_.vertices;
  }
}

}  // namespace

ShortenCounts shorten_rows(GapMesh& gap, hybrid::SurfaceTags& tags, const shape::InputSurface& surface,
                           bool chosen_may_go) {
  return RowShortener(gap, tags, surface).run(chosen_may_go);
}

}  // namespace hexpipe::assemble::gap
