#include "common/candidates/quads.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "common/mesh/cell_measures.hpp"
#include "common/mesh/lanes.hpp"
#include "common/mesh/quality.hpp"

namespace hexpipe::candidates {
namespace {

// The angles are a filter before the test of the corners; its rounding must not reject corners that the test accepts.
constexpr double filter_slack = 1 - 1e-9;

// By edge of a row: bits of the edges for which rule 3 holds at the corner formed with a spoke and this edge.
using CornerBits = std::array<std::uint64_t, EdgeRow::most>;

HEXPIPE_ANY_REGISTERS void judge_corners(const Vec3& spoke, double spoke_square, const EdgeRow& row, double min_quality,
                                         CornerBits& suffices) {
  for (int begin = 0; begin < row.size; begin += lane_count) {
    const LaneVector normals = cross(spoke, row.vectors[begin / lane_count]);
    const Lanes squares = spoke_square * row.squares[begin / lane_count];
    LaneMask bits{};
    for (int next = 0; next < row.size; ++next) {
      const int lane = next % lane_count;
      const LaneVector& nexts = row.vectors[next / lane_count];
      const Vec3 vector{nexts.x[lane], nexts.y[lane], nexts.z[lane]};
      const Lanes determinants = -dot(normals, vector);
      bits |= scaled_jacobian_exceeds(determinants, squares * row.squares[next / lane_count][lane], min_quality) &
              (std::int64_t{1} << next);
    }
    std::memcpy(&suffices[begin], &bits, sizeof bits);
  }
}

// The edges of a row that may be the third one at a corner, as bits.
HEXPIPE_ANY_REGISTERS std::uint64_t judge_third_edges(const Vec3& edge, const Vec3& next, double two_squares,
                                                      const EdgeRow& row, double min_quality) {
  std::uint64_t suffices = 0;
  for (int begin = 0; begin < row.size; begin += lane_count) {
    const Lanes determinants = dot(cross(next, row.vectors[begin / lane_count]), edge);
    const LaneMask enough =
        scaled_jacobian_exceeds(determinants, two_squares * row.squares[begin / lane_count], min_quality);
    suffices |= std::uint64_t{bits_of(enough)} << begin;
  }
  return row.size < EdgeRow::most ? suffices & ((std::uint64_t{1} << row.size) - 1) : suffices;
}

}  // namespace

QuadAngle::QuadAngle(const VertexLinks& links, Vertex corner, int place, int other_place)
    : corner_(corner),
      side_(links.neighbours_of(corner)[place]),
      other_side_(links.neighbours_of(corner)[other_place]),
      place_(place),
      other_place_(other_place),
      sides_are_linked_(links.are_linked(corner, place, other_place)),
      is_narrow_(links.is_narrow(corner) && (!sides_are_linked_ || links.is_narrow(side_))) {
  if (!is_narrow_) return;
  along_ = links.links_of(corner, place) & links.links_of(corner, other_place);
  if (sides_are_linked_) between_ = links.links_of(side_, links.place_of(other_side_, side_));
}

bool QuadAngle::has_opposite_among_many(const VertexLinks& links) const {
  return links.have_common_link(corner_, place_, other_place_) ||
         (sides_are_linked_ && links.link_count_exceeds_one(side_, links.place_of(other_side_, side_)));
}

bool QuadAngle::has_opposite_among_many(const VertexLinks& links, Vertex opposite) const {
  if (const int place = links.place_of(opposite, corner_);
      place != no_index && links.are_linked(corner_, place_, place) && links.are_linked(corner_, other_place_, place))
    return true;
  return sides_are_linked_ && links.is_facet(side_, other_side_, opposite);
}

// The corner itself is linked to its sides, so it is among the vertices at their other diagonal. It is overwritten.
std::span<const OppositeCorner> QuadAngle::find_opposites(const VertexLinks& links,
                                                          std::vector<OppositeCorner>& memory) const {
  if (!is_narrow_) return find_among_many(links, memory);
  memory.resize(std::max(memory.size(), 2 * VertexLinks::most_narrow));
  OppositeCorner* next = memory.data();
  const auto beside_corner = links.neighbours_of(corner_), beside_side = links.neighbours_of(side_);
  std::uint64_t along = along_, between = between_;
  while (along != 0 && between != 0) {
    const Vertex a = beside_corner[std::countr_zero(along)], b = beside_side[std::countr_zero(between)];
    *next = {std::min(a, b), static_cast<Diagonals>((a <= b ? from_corner : 0) | (b <= a ? between_sides : 0))};
    next += next->vertex != corner_ ? 1 : 0;
    along &= along - (a <= b ? 1 : 0);
    between &= between - (b <= a ? 1 : 0);
  }
  for (; along != 0; along &= along - 1) *next++ = {beside_corner[std::countr_zero(along)], from_corner};
  for (; between != 0; between &= between - 1) {
    *next = {beside_side[std::countr_zero(between)], between_sides};
    next += next->vertex != corner_ ? 1 : 0;
  }
  return {memory.data(), next};
}

std::span<const OppositeCorner> QuadAngle::find_among_many(const VertexLinks& links,
                                                           std::vector<OppositeCorner>& memory) const {
  memory.clear();
  const auto neighbours = links.neighbours_of(corner_);
  links.for_each_linked_to_both(corner_, place_, other_place_, [&](int p) {
    memory.push_back({neighbours[p], from_corner});
  });
  if (!sides_are_linked_) return memory;

  const auto beside = links.neighbours_of(side_);
  links.for_each_linked(side_, links.place_of(other_side_, side_), [&](int p) {
    if (beside[p] != corner_) memory.push_back({beside[p], between_sides});
  });
  if (memory.empty()) return memory;
  std::sort(memory.begin(), memory.end(),
            [](const OppositeCorner& a, const OppositeCorner& b) { return a.vertex < b.vertex; });
  auto last = memory.begin();
  for (auto next = last + 1; next != memory.end(); ++next) {
    if (last->vertex == next->vertex)
      last->diagonals = from_corner | between_sides;
    else
      *++last = *next;
  }
  return {memory.begin(), last + 1};
}

bool has_unfolded_diagonal(const TetMesh& mesh, const VertexLinks& links, Vertex a, Vertex b, Vertex c, Vertex d) {
  const Vec3 &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c], &s = mesh.points[d];
  return (!is_folded(p, q, r, s) && links.is_facet(a, b, c) && links.is_facet(a, c, d)) ||
         (!is_folded(q, r, s, p) && links.is_facet(b, c, d) && links.is_facet(b, d, a));
}

bool has_unfolded_diagonal(const TetMesh& mesh, Diagonals diagonals, Vertex a, Vertex b, Vertex c, Vertex d) {
  const Vec3 &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c], &s = mesh.points[d];
  return ((diagonals & from_corner) != 0 && !is_folded(p, q, r, s)) ||
         ((diagonals & between_sides) != 0 && !is_folded(q, r, s, p));
}

void QuadFan::find(Vertex first) {
  first_ = first;
  quads_.clear();
  pairs_.clear();
  outer_edges_.clear();
  slots_.assign(least_slots, no_index);
  are_all_judged_ = true;
  measure_spokes();
  const int count = static_cast<int>(links_.neighbours_of(first).size());
  for (int place = first_place_; place < count; ++place)
    links_.for_each_within_two_links(first, place, first_place_, [&](int other_place) {
      const Spoke &a = spokes_[place - first_place_], &b = spokes_[other_place - first_place_];
      if (angle_suffices(a.vector, a.square, b.vector, b.square)) find_between(place, other_place);
    });
  table_pairs();
  for (const Spoke& spoke : spokes_) judge_corners_at(spoke);
  for (Pair& pair : pairs_) collect_outer_edges(pair);
}

void QuadFan::measure_spokes() {
  const auto neighbours = links_.neighbours_of(first_);
  const auto greater = std::upper_bound(neighbours.begin(), neighbours.end(), first_);
  first_place_ = static_cast<int>(greater - neighbours.begin());
  spokes_.clear();
  for (auto neighbour = greater; neighbour != neighbours.end(); ++neighbour) {
    const Vec3 vector = mesh_.points[*neighbour] - mesh_.points[first_];
    const double square = norm_squared(vector);
    const std::size_t row = spokes_.size() / EdgeRow::most;
    if (row == spoke_rows_.size()) spoke_rows_.emplace_back();
    if (spokes_.size() % EdgeRow::most == 0) spoke_rows_[row].size = 0;
    spokes_.push_back({vector, square});
    spoke_rows_[row].add(vector, square);
  }
}

void QuadFan::find_between(int place, int other_place) {
  const auto neighbours = links_.neighbours_of(first_);
  const auto begin = static_cast<std::int32_t>(quads_.size());
  const QuadAngle angle(links_, first_, place, other_place);
  for (const auto& [opposite, diagonals] : angle.find_opposites(links_, found_)) {
    if (opposite < first_) continue;
    const std::int32_t edge = outer_edge(place, opposite), other_edge = outer_edge(other_place, opposite);
    if (!is_wanted(outer_edges_[edge], outer_edges_[other_edge]) ||
        (filter_.drop_folded &&
         !has_unfolded_diagonal(mesh_, diagonals, first_, neighbours[place], opposite, neighbours[other_place])))
      continue;
    number_outer_edge(edge);
    number_outer_edge(other_edge);
    quads_.push_back({opposite, {edge, other_edge}, diagonals});
  }
  const auto end = static_cast<std::int32_t>(quads_.size());
  if (begin < end) pairs_.push_back({{place, other_place}, begin, end});
}

void QuadFan::table_pairs() {
  const std::size_t count = spokes_.size(), words = word_count();
  partner_bits_.assign(count * words, 0);
  if (count <= most_tabled) pair_of_spokes_.assign(count * count, no_index);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const std::size_t a = pairs_[i].places[0] - first_place_, b = pairs_[i].places[1] - first_place_;
    partner_bits_[a * words + b / 64] |= std::uint64_t{1} << b % 64;
    partner_bits_[b * words + a / 64] |= std::uint64_t{1} << a % 64;
    if (count <= most_tabled)
      pair_of_spokes_[a * count + b] = pair_of_spokes_[b * count + a] = static_cast<std::int32_t>(i);
  }
}

std::uint64_t QuadFan::third_edges(int place, int next_place, std::size_t word) const {
  const Spoke &edge = spokes_[place - first_place_], &next = spokes_[next_place - first_place_];
  return judge_third_edges(edge.vector, next.vector, edge.square * next.square, spoke_rows_[word], filter_.min_quality);
}

bool QuadFan::is_wanted(const OuterEdge& edge, const OuterEdge& other_edge) const {
  return edge.angle_suffices && other_edge.angle_suffices &&
         angle_suffices(edge.vector, edge.square, other_edge.vector, other_edge.square);
}

bool QuadFan::angle_suffices(const Vec3& u, double u_square, const Vec3& v, double v_square) const {
  const double least = filter_.min_quality * filter_.min_quality * filter_slack;
  return norm_squared(cross(u, v)) >= least * u_square * v_square;
}

std::size_t QuadFan::first_slot(int place, Vertex end) const {
  const std::uint32_t hash =
      (static_cast<std::uint32_t>(place) * 0x9e3779b9u + static_cast<std::uint32_t>(end)) * 0x85ebca6bu;
  return (hash >> 12) & (slots_.size() - 1);
}

std::int32_t QuadFan::outer_edge(int place, Vertex end) {
  const int spoke = place - first_place_;
  std::size_t slot = first_slot(spoke, end);
  for (; slots_[slot] != no_index; slot = (slot + 1) & (slots_.size() - 1)) {
    const OuterEdge& edge = outer_edges_[slots_[slot]];
    if (edge.spoke == spoke && edge.end == end) return slots_[slot];
  }
  const auto number = static_cast<std::int32_t>(outer_edges_.size());
  slots_[slot] = number;
  const Vec3 vector = mesh_.points[end] - mesh_.points[links_.neighbours_of(first_)[place]];
  const double square = norm_squared(vector);
  const Spoke& from = spokes_[spoke];
  outer_edges_.push_back({vector, square, end, spoke, angle_suffices(from.vector, from.square, vector, square)});
  if (2 * outer_edges_.size() > slots_.size()) widen_slots();
  return number;
}

// Numbers an outer edge that is in a quad.
void QuadFan::number_outer_edge(std::int32_t outer_edge) {
  OuterEdge& edge = outer_edges_[outer_edge];
  if (edge.number != no_index) return;
  Spoke& spoke = spokes_[edge.spoke];
  edge.place = links_.place_of(edge.end, links_.neighbours_of(first_)[edge.spoke + first_place_]);
  edge.number = spoke.count++;
  edge.before = std::exchange(spoke.last, outer_edge);
}

void QuadFan::widen_slots() {
  slots_.assign(2 * slots_.size(), no_index);
  for (std::size_t i = 0; i < outer_edges_.size(); ++i) {
    std::size_t slot = first_slot(outer_edges_[i].spoke, outer_edges_[i].end);
    while (slots_[slot] != no_index) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = static_cast<std::int32_t>(i);
  }
}

void QuadFan::judge_corners_at(const Spoke& spoke) {
  at_spoke_.clear();
  for (std::int32_t i = spoke.last; i != no_index; i = outer_edges_[i].before) at_spoke_.push_back(i);
  if (spoke.count > most_numbered) {
    are_all_judged_ = false;
    for (const std::int32_t i : at_spoke_) {
      outer_edges_[i].number = most_numbered;
      outer_edges_[i].suffices_before = outer_edges_[i].suffices_after = ~std::uint64_t{0};
    }
    return;
  }
  std::reverse(at_spoke_.begin(), at_spoke_.end());
  row_.size = 0;
  for (const std::int32_t i : at_spoke_) row_.add(outer_edges_[i].vector, outer_edges_[i].square);
  CornerBits before, after{};
  judge_corners(spoke.vector, spoke.square, row_, filter_.min_quality, before);
  for (int number = 0; number < row_.size; ++number) {
    before[number] &= ~(std::uint64_t{1} << number);
    for (std::uint64_t bits = before[number]; bits != 0; bits &= bits - 1)
      after[std::countr_zero(bits)] |= std::uint64_t{1} << number;
  }
  for (int number = 0; number < row_.size; ++number) {
    OuterEdge& edge = outer_edges_[at_spoke_[number]];
    edge.suffices_before = before[number];
    edge.suffices_after = after[number];
  }
}

void QuadFan::collect_outer_edges(Pair& pair) {
  for (Quad& quad : std::span(quads_).subspan(pair.begin, pair.end - pair.begin))
    for (std::size_t side = 0; side < 2; ++side) {
      const int number = outer_edges_[quad.outer_edges[side]].number;
      const bool is_bit = number < most_numbered;
      quad.numbers[side] = is_bit ? static_cast<std::uint8_t>(number) : 0;
      pair.outer_edges[side] |= is_bit ? std::uint64_t{1} << number : ~std::uint64_t{0};
    }
}

bool QuadFan::corner_suffices(const OuterEdge& edge, const OuterEdge& next) const {
  const Spoke& spoke = spokes_[edge.spoke];
  return &edge != &next && scaled_jacobian_exceeds(-dot(cross(spoke.vector, edge.vector), next.vector),
                                                   spoke.square * edge.square * next.square, filter_.min_quality);
}

auto QuadFan::find_pair_among_many(int place, int other_place) const -> const Pair* {
  const std::array<int, 2> wanted{std::min(place, other_place), std::max(place, other_place)};
  const auto at =
      std::lower_bound(pairs_.begin(), pairs_.end(), wanted,
                       [](const Pair& pair, const std::array<int, 2>& places) { return pair.places < places; });
  return at != pairs_.end() && at->places == wanted ? &*at : nullptr;
}

}  // namespace hexpipe::candidates
