#include "common/mwis/local_search/push_gains.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <vector>

#include "common/mesh/lanes.hpp"

namespace hexpipe::mwis::local_search {
namespace {

// A vector has as many gains as fit into the widest registers, and a block those of one word of a row.
constexpr std::size_t vector_bytes = 64, block = 64;
using Narrow [[gnu::vector_size(vector_bytes)]] = std::int32_t;
using Wide [[gnu::vector_size(vector_bytes)]] = std::int64_t;

// 32 MiB of bits.
constexpr std::int32_t most_vertices = 16384;
constexpr std::size_t changes_at_once = 4;

template <class Vector>
using GainOf = std::remove_cvref_t<decltype(Vector{}[0])>;
template <class Vector>
constexpr std::size_t lanes = vector_bytes / sizeof(GainOf<Vector>);
template <class Vector>
constexpr std::size_t vectors_a_block = block / lanes<Vector>;
// A word of a row is looked at in pieces that fit into a lane.
template <class Vector>
constexpr std::size_t pieces_a_word = sizeof(bits::Word) / sizeof(GainOf<Vector>);
template <class Vector>
constexpr std::size_t vectors_a_piece = vectors_a_block<Vector> / pieces_a_word<Vector>;
// Gains of barred vertices are lower by this much, which is more than any two gains differ by. Behind the last vertex
// there is nothing to be found either.
template <class Vector>
constexpr GainOf<Vector> bar_of = std::numeric_limits<GainOf<Vector>>::max() / 2 + 1;
template <class Vector>
constexpr GainOf<Vector> nothing = std::numeric_limits<GainOf<Vector>>::min();

// Code compiled for narrow registers would not align vectors in memory as that for wide ones needs it.
template <class Vector>
struct alignas(vector_bytes) Aligned {
  Vector lanes;
};

template <class Vector>
struct Change {
  const bits::Word* row;
  GainOf<Vector> by;
};

// By vector of a piece: the bit of each lane.
template <class Vector>
const std::array<Aligned<Vector>, vectors_a_piece<Vector>> bits_of_lanes = [] {
  using Gain = GainOf<Vector>;
  std::array<Aligned<Vector>, vectors_a_piece<Vector>> result{};
  for (std::size_t i = 0; i < 8 * sizeof(Gain); ++i)
    result[i / lanes<Vector>].lanes[i % lanes<Vector>] = static_cast<Gain>(std::make_unsigned_t<Gain>{1} << i);
  return result;
}();

// Adds each change to the gains of its row and keeps the greatest of each block, lane by lane.
template <class Vector, std::size_t count>
void apply(const Change<Vector>* changes, std::size_t words, Aligned<Vector>* gains, Aligned<Vector>* greatest_of_block,
           Aligned<Vector>& result) {
  using Gain = GainOf<Vector>;
  std::array<Vector, count> by;
  for (std::size_t i = 0; i < count; ++i) by[i] = Vector{} + changes[i].by;
  Vector greatest = Vector{} + nothing<Vector>;
  for (std::size_t w = 0; w < words; ++w) {
    Vector of_block = Vector{} + nothing<Vector>;
    for (std::size_t piece = 0; piece < pieces_a_word<Vector>; ++piece) {
      for (std::size_t j = 0; j < vectors_a_piece<Vector>; ++j) {
        Vector& at = gains[(w * pieces_a_word<Vector> + piece) * vectors_a_piece<Vector> + j].lanes;
        Vector sum = at;
        for (std::size_t i = 0; i < count; ++i) {
          // Made anew for each vector: gcc 12 fills an array of vectors lane by lane.
          const Vector members = Vector{} + static_cast<Gain>(changes[i].row[w] >> (piece * 8 * sizeof(Gain)));
          sum += ((members & bits_of_lanes<Vector>[j].lanes) != 0) & by[i];
        }
        at = sum;
        of_block = of_block > sum ? of_block : sum;
      }
    }
    greatest_of_block[w].lanes = of_block;
    greatest = greatest > of_block ? greatest : of_block;
  }
  result.lanes = greatest;
}

template <class Vector>
void apply_some(const Change<Vector>* changes, std::size_t count, std::size_t words, Aligned<Vector>* gains,
                Aligned<Vector>* greatest_of_block, Aligned<Vector>& greatest) {
  switch (count) {
    case 0:
      return apply<Vector, 0>(changes, words, gains, greatest_of_block, greatest);
    case 1:
      return apply<Vector, 1>(changes, words, gains, greatest_of_block, greatest);
    case 2:
      return apply<Vector, 2>(changes, words, gains, greatest_of_block, greatest);
    case 3:
      return apply<Vector, 3>(changes, words, gains, greatest_of_block, greatest);
    default:
      return apply<Vector, changes_at_once>(changes, words, gains, greatest_of_block, greatest);
  }
}

HEXPIPE_ANY_REGISTERS void apply_changes(const Change<Narrow>* changes, std::size_t count, std::size_t words,
                                         Aligned<Narrow>* gains, Aligned<Narrow>* greatest_of_block,
                                         Aligned<Narrow>& greatest) {
  apply_some(changes, count, words, gains, greatest_of_block, greatest);
}
HEXPIPE_ANY_REGISTERS void apply_changes(const Change<Wide>* changes, std::size_t count, std::size_t words,
                                         Aligned<Wide>* gains, Aligned<Wide>* greatest_of_block,
                                         Aligned<Wide>& greatest) {
  apply_some(changes, count, words, gains, greatest_of_block, greatest);
}

template <class Vector>
class GainsIn final : public PushGains {
  using Gain = GainOf<Vector>;

 public:
  explicit GainsIn(const ground::DenseGraph& graph)
      : graph_(graph),
        gains_(graph.words() * vectors_a_block<Vector>, {Vector{} + nothing<Vector>}),
        greatest_of_block_(graph.words()) {
    for (std::size_t v = 0; v < graph.size(); ++v) set(v, static_cast<Gain>(graph.weight(v)));
  }

  void bar(std::size_t v) override { set(v, at(v) - bar_of<Vector>); }
  void free(std::size_t v) override { set(v, at(v) + bar_of<Vector>); }
  void come_in(std::size_t v) override { change(v, -static_cast<Gain>(graph_.weight(v))); }
  void go_out(std::size_t v) override { change(v, static_cast<Gain>(graph_.weight(v))); }
  std::optional<std::int64_t> settle() override {
    apply_pending();
    if (greatest_ <= -bar_of<Vector> / 2) return std::nullopt;
    return greatest_;
  }
  std::int64_t gain(std::size_t v) const override { return at(v); }
  std::size_t greatest(Random& random) const override {
    const auto first_from = [](std::size_t begin, std::size_t count, auto&& is_wanted) {
      std::size_t i = begin;
      while (!is_wanted(i)) i = i + 1 == count ? 0 : i + 1;
      return i;
    };
    const std::uint64_t draw = random.next();
    const std::size_t lane = first_from(draw % lanes<Vector>, lanes<Vector>,
                                        [&](std::size_t i) { return greatest_of_lane_.lanes[i] == greatest_; });
    const std::size_t words = graph_.words();
    const std::size_t w = first_from((draw >> 32) * words >> 32, words,
                                     [&](std::size_t i) { return greatest_of_block_[i].lanes[lane] == greatest_; });
    const auto vertex = [&](std::size_t i) { return block * w + lanes<Vector> * i + lane; };
    return vertex(first_from(draw / lanes<Vector> % vectors_a_block<Vector>, vectors_a_block<Vector>,
                             [&](std::size_t i) { return at(vertex(i)) == greatest_; }));
  }

 private:
  Gain at(std::size_t v) const { return gains_[v / lanes<Vector>].lanes[v % lanes<Vector>]; }
  void set(std::size_t v, Gain gain) { gains_[v / lanes<Vector>].lanes[v % lanes<Vector>] = gain; }

  void change(std::size_t v, Gain by) {
    if (pending_ == changes_at_once) apply_pending();
    changes_[pending_++] = {graph_.row(v), by};
  }
  void apply_pending() {
    apply_changes(changes_.data(), pending_, graph_.words(), gains_.data(), greatest_of_block_.data(),
                  greatest_of_lane_);
    pending_ = 0;
    greatest_ = greatest_of_lane_.lanes[0];
    for (std::size_t i = 1; i < lanes<Vector>; ++i) greatest_ = std::max<Gain>(greatest_, greatest_of_lane_.lanes[i]);
  }

  const ground::DenseGraph& graph_;
  std::vector<Aligned<Vector>> gains_, greatest_of_block_;
  Aligned<Vector> greatest_of_lane_{};
  Gain greatest_ = 0;
  std::array<Change<Vector>, changes_at_once> changes_{};
  std::size_t pending_ = 0;
};

// All gains lie between minus the weight of all vertices and the greatest weight.
std::int64_t most_weight(std::int64_t bar) {
  return bar / 4;
}

}  // namespace

bool PushGains::suit(const graph::ConflictGraph& graph) {
  if (graph.vertex_count() > most_vertices) return false;
  std::int64_t left = most_weight(bar_of<Wide>);
  return std::ranges::all_of(graph.weights,
                             [&](std::int64_t weight) { return weight <= left && (left -= weight, true); });
}

std::unique_ptr<PushGains> PushGains::make(const ground::DenseGraph& graph) {
  const auto weights = graph.weights();
  if (std::reduce(weights.begin(), weights.end(), std::int64_t{0}) <= most_weight(bar_of<Narrow>))
    return std::make_unique<GainsIn<Narrow>>(graph);
  return std::make_unique<GainsIn<Wide>>(graph);
}

}  // namespace hexpipe::mwis::local_search
