#include "tools/tetmesh/fields/whole_rows.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

#include "common/run/parallel.hpp"

namespace hexpipe::tetmesh::fields {
namespace {

// A coordinate is that of something else, with its sign turned if `flipped`, plus the offset.
struct SeenCoordinate {
  std::int32_t from = no_index;
  bool flipped = false;
  double offset = 0;

  double turned(double coordinate) const { return flipped ? -coordinate : coordinate; }
  // What it is seen from, given as seen from a third.
  SeenCoordinate through(const SeenCoordinate& middle) const {
    return {middle.from, flipped != middle.flipped, turned(middle.offset) + offset};
  }
  // What it is seen from, as seen from `here`.
  SeenCoordinate back(std::int32_t here) const { return {here, flipped, -turned(offset)}; }
};

// Sets of coordinates that are whole numbers apart.
class WholeSets {
 public:
  explicit WholeSets(std::size_t coordinates) : parents_(coordinates), sizes_(coordinates, 1) {
    for (std::size_t i = 0; i < coordinates; ++i) parents_[i].from = static_cast<std::int32_t>(i);
  }

  // From one coordinate of its set, which is the same one for all of them.
  SeenCoordinate of(std::int32_t coordinate) {
    way_.clear();
    for (std::int32_t i = coordinate; parents_[i].from != i; i = parents_[i].from) way_.push_back(i);
    // All on the way see the root from now on. The last one does already.
    for (std::size_t i = way_.size(); i-- > 1;)
      parents_[way_[i - 1]] = parents_[way_[i - 1]].through(parents_[way_[i]]);
    return parents_[coordinate];
  }

  // What contradicts earlier calls is ignored: rows end there.
  void join(std::int32_t coordinate, const SeenCoordinate& seen) {
    const SeenCoordinate own = of(coordinate), other = of(seen.from);
    if (own.from == other.from) return;
    // The set of this coordinate, as seen from the other set.
    const SeenCoordinate joint = own.back(coordinate).through(seen.through(other));
    const bool is_larger = sizes_[own.from] > sizes_[other.from];
    const auto [root, leaf] = is_larger ? std::pair(own.from, other.from) : std::pair(other.from, own.from);
    parents_[leaf] = is_larger ? joint.back(own.from) : joint;
    sizes_[root] += sizes_[leaf];
  }

 private:
  std::vector<SeenCoordinate> parents_;
  std::vector<std::int32_t> sizes_;  // of the sets of roots
  std::vector<std::int32_t> way_;
};

// What an offset that is not whole costs, in the unit of squared stretches: rows that end cost more than rows that
// stretch.
constexpr double price_of_misses = 20;
constexpr double most_stretch = 0.35;  // of what lies between two sets
constexpr double shortest_gap = 1e-6;  // between sets, in sizes
constexpr int most_rounds = 10;
// A set asks so many of the others where it might go, those that it sees best.
constexpr std::size_t most_asked = 32;
constexpr double least_saving = 1e-9;

// What a set sees of another.
struct Sight {
  std::int32_t other;
  bool flipped;
  double offset;  // from -1/2 to 1/2: this one from the other, but for whole numbers
  double weight, length;
};

// Sets are placed one after the other, each with those before it that it sees best, and then moved as long as that is
// better.
class Shifter {
 public:
  Shifter(std::span<const std::int32_t> sizes, std::span<const SetGap> gaps)
      : sizes_(sizes), sights_(sizes.size()), is_placed_(sizes.size()), shifts_(sizes.size()) {
    for (const SetGap& gap : gaps) {
      const SeenCoordinate seen{gap.first, gap.flipped, coordinate_of(gap.offset)};
      const SeenCoordinate back = seen.back(gap.second);
      // Links that contradict each other, because a singularity is between, count less.
      const double weight = std::abs(gap.offset), length = std::max(gap.length / gap.weight, shortest_gap);
      sights_[gap.second].push_back({gap.first, gap.flipped, seen.offset, weight, length});
      sights_[gap.first].push_back({gap.second, gap.flipped, back.offset, weight, length});
    }
    for (std::vector<Sight>& sights : sights_) std::ranges::stable_sort(sights, std::ranges::greater(), &Sight::weight);
  }

  std::vector<double> solve() {
    place_all();
    for (int round = 0; round < most_rounds && move_all(); ++round) continue;
    return shifts_;
  }

 private:
  void place_all();
  bool move_all();
  // Or that much, if it costs more.
  double cost_of(std::size_t set, double shift, double most) const;
  double best_of(std::size_t set) const;
  // The other's shift, as this set sees it.
  double shift_of(const Sight& sight) const { return sight.flipped ? -shifts_[sight.other] : shifts_[sight.other]; }

  std::span<const std::int32_t> sizes_;
  std::vector<std::vector<Sight>> sights_;
  std::vector<bool> is_placed_;
  std::vector<double> shifts_;
};

void Shifter::place_all() {
  using Candidate = std::tuple<double, std::int32_t, std::size_t>;  // sight of what is placed, size, set
  std::priority_queue<Candidate> queue;
  std::vector<double> sight(sizes_.size());
  for (std::size_t set = 0; set < sizes_.size(); ++set) queue.emplace(0, sizes_[set], set);
  while (!queue.empty()) {
    const std::size_t set = std::get<2>(queue.top());
    queue.pop();
    if (is_placed_[set]) continue;
    shifts_[set] = best_of(set);
    is_placed_[set] = true;
    for (const Sight& to : sights_[set]) {
      if (is_placed_[to.other]) continue;
      sight[to.other] += to.weight;
      queue.emplace(sight[to.other], sizes_[to.other], to.other);
    }
  }
}

bool Shifter::move_all() {
  bool has_moved = false;
  for (std::size_t set = 0; set < sizes_.size(); ++set) {
    const double best = best_of(set);
    has_moved |= best != shifts_[set];
    shifts_[set] = best;
  }
  return has_moved;
}

double Shifter::cost_of(std::size_t set, double shift, double most) const {
  double sum = 0;
  for (const Sight& sight : sights_[set]) {
    if (!is_placed_[sight.other]) continue;
    if (sum >= most) return most;
    const double change = shift - shift_of(sight);
    const double miss = sight.offset + change - std::round(sight.offset + change);
    const bool is_too_far = std::abs(change) > most_stretch * sight.length;
    sum += sight.weight * (price_of_misses * (miss * miss + (is_too_far ? 1 : 0)) + change * change / sight.length);
  }
  return sum;
}

double Shifter::best_of(std::size_t set) const {
  double best = shifts_[set], least = cost_of(set, best, HUGE_VAL);
  const auto take = [&](double shift) {
    const double cost = cost_of(set, shift, least);
    if (cost >= least - least_saving) return;
    least = cost;
    best = shift;
  };
  take(0);
  std::size_t asked = 0;
  for (const Sight& sight : sights_[set]) {
    if (!is_placed_[sight.other]) continue;
    if (++asked > most_asked) break;
    for (const int whole : {-1, 0, 1}) take(shift_of(sight) - sight.offset + whole);
  }
  return best;
}

// Joins what many links say of the same two sets.
std::vector<SetGap> joined(std::vector<SetGap> gaps) {
  const auto key = [](const SetGap& gap) { return std::tuple(gap.first, gap.second, gap.flipped); };
  std::ranges::stable_sort(gaps, {}, key);
  std::vector<SetGap> result;
  for (const SetGap& gap : gaps) {
    if (result.empty() || key(result.back()) != key(gap)) {
      result.push_back(gap);
      continue;
    }
    result.back().weight += gap.weight;
    result.back().offset += gap.offset;
    result.back().length += gap.length;
  }
  return result;
}

template <std::size_t K>
class RowRounding {
 public:
  using Shifts = std::vector<std::array<double, K>>;

  RowRounding(const LinkedNodes<K>& nodes, const HeldCoordinates<K>& held)
      : nodes_(nodes),
        held_(held),
        sets_(K * nodes.size()),
        set_of_(K * nodes.size(), no_index),
        seen_(K * nodes.size()),
        way_(K * nodes.size()) {}

  Shifts shifts() {
    join_sets();
    number_sets();
    if (sizes_.size() < 2) return {};
    spread();
    const std::vector<double> of_sets = whole_shifts(sizes_, find_gaps());
    if (std::ranges::all_of(of_sets, [](double shift) { return shift == 0; })) return {};
    return spread_out(of_sets);
  }

 private:
  template <class Body>
  void for_each_node(Body&& body) const {
    parallel_for(static_cast<std::int64_t>(nodes_.size()), 256,
                 [&](std::int64_t i) { body(static_cast<std::size_t>(i)); });
  }
  // Held coordinates beside each other are apart by a whole number if the distance says so up to this.
  static constexpr double nearly_whole = 0.15;
  // Fewer held coordinates make no set. They lie where features bend, and hold what is near to them.
  static constexpr std::int32_t least_size = 4;
  static constexpr DiffusionLimits limits{150, 3e-3};

  static std::int32_t number_of(std::size_t node, std::size_t k) { return static_cast<std::int32_t>(K * node + k); }
  static SeenCoordinate seen_by(const PeriodicLink<K>& link, std::size_t k) {
    return {number_of(static_cast<std::size_t>(link.neighbour), link.axis[k]), link.flipped[k], link.distance[k]};
  }
  // Calls body(i, k, link) for all coordinates and the links that have a weight.
  template <class Body>
  void for_each_view(Body&& body) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      for (const PeriodicLink<K>& link : nodes_.links_of(i)) {
        if (link.weight <= 0 || static_cast<std::size_t>(link.neighbour) < i) continue;
        for (std::size_t k = 0; k < K; ++k) body(i, k, link);
      }
  }
  static double length_of(const PeriodicLink<K>& link) {
    double squared = 0;
    for (const double distance : link.distance) squared += distance * distance;
    return std::sqrt(squared);
  }

  void join_sets() {
    for_each_view([&](std::size_t i, std::size_t k, const PeriodicLink<K>& link) {
      const std::optional<double> here = held_[i][k];
      if (!here) return;
      const auto there = held_[static_cast<std::size_t>(link.neighbour)][link.axis[k]];
      if (!there) return;
      SeenCoordinate seen = seen_by(link, k);
      seen.offset += seen.turned(*there) - *here;
      const double whole = std::round(seen.offset);
      if (std::abs(seen.offset - whole) > nearly_whole) return;
      seen.offset = whole;
      sets_.join(number_of(i, k), seen);
    });
  }

  void number_sets() {
    std::vector<std::int32_t> sizes(K * nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      for (std::size_t k = 0; k < K; ++k)
        if (held_[i][k]) ++sizes[sets_.of(number_of(i, k)).from];
    for (std::size_t n = 0; n < sizes.size(); ++n) {
      if (sizes[n] < least_size) continue;
      set_of_[n] = static_cast<std::int32_t>(sizes_.size());
      sizes_.push_back(sizes[n]);
    }
  }

  // Every coordinate is seen from the set that is fewest links away.
  void spread() {
    std::vector<std::int32_t> queue;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      for (std::size_t k = 0; k < K; ++k) {
        const std::optional<double> held = held_[i][k];
        if (!held) continue;
        SeenCoordinate seen = sets_.of(number_of(i, k));
        const std::int32_t set = set_of_[seen.from];
        if (set == no_index) continue;
        seen.from = set;
        seen.offset += *held;
        seen_[number_of(i, k)] = seen;
        queue.push_back(number_of(i, k));
      }
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const std::int32_t number = queue[next];
      const std::size_t node = number / K, axis = number % K;
      for (const PeriodicLink<K>& link : nodes_.links_of(node)) {
        if (link.weight <= 0) continue;
        const SeenCoordinate there = seen_by(link, axis);
        if (seen_[there.from].from != no_index) continue;
        seen_[there.from] = there.back(number).through(seen_[number]);
        way_[there.from] = way_[number] + length_of(link);
        queue.push_back(there.from);
      }
    }
  }

  std::vector<SetGap> find_gaps() const {
    std::vector<SetGap> gaps;
    for_each_view([&](std::size_t i, std::size_t k, const PeriodicLink<K>& link) {
      const std::int32_t number = number_of(i, k);
      const SeenCoordinate& here = seen_[number];
      const SeenCoordinate onward = seen_by(link, k), &there = seen_[onward.from];
      if (here.from == no_index || there.from == no_index || here.from == there.from) return;
      // This set, as seen from the other.
      SeenCoordinate seen = here.back(number).through(onward.through(there));
      const auto [first, second] = std::minmax(here.from, there.from);
      if (second != here.from) seen = seen.back(here.from);
      const double length = way_[number] + length_of(link) + way_[onward.from];
      gaps.push_back(
          {first, second, seen.flipped, link.weight, link.weight * number_at(seen.offset), link.weight * length});
    });
    return joined(std::move(gaps));
  }

  // The set that holds a coordinate, or no_index.
  std::int32_t holder_of(std::size_t i, std::size_t k) {
    return held_[i][k] ? set_of_[sets_.of(number_of(i, k)).from] : no_index;
  }

  // The shifts of sets, spread over what lies between them so that it stretches evenly. A shift is the imaginary part
  // of a number, for where coordinates run against each other, that of the conjugate is the shift turned round.
  Shifts spread_out(const std::vector<double>& of_sets) {
    std::vector<double> degree(nodes_.size());
    std::vector<std::array<bool, K>> is_fixed(nodes_.size());
    PeriodicNumbers<K> fixed(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      for (const PeriodicLink<K>& link : nodes_.links_of(i)) degree[i] += link.weight;
      degree[i] = std::max(degree[i], 1e-9);
      for (std::size_t k = 0; k < K; ++k) {
        const std::int32_t set = holder_of(i, k);
        is_fixed[i][k] = set != no_index;
        if (set != no_index) fixed[i][k] = Complex(0, seen_[number_of(i, k)].turned(of_sets[set]));
      }
    }
    // Nothing pulls at what is fixed.
    const auto pull = [&](const PeriodicNumbers<K>& numbers, std::size_t i) {
      std::array<Complex, K> sum{};
      for (const PeriodicLink<K>& link : nodes_.links_of(i))
        for (std::size_t k = 0; k < K; ++k) {
          const Complex& there = numbers[link.neighbour][link.axis[k]];
          if (!is_fixed[i][k]) sum[k] += link.weight * (link.flipped[k] ? std::conj(there) : there);
        }
      return sum;
    };
    PeriodicNumbers<K> pulls(nodes_.size());
    for_each_node([&](std::size_t i) { pulls[i] = pull(fixed, i); });
    const PeriodicNumbers<K> others = diffused<K>(
        std::move(pulls), limits, [&](const auto& body) { for_each_node(body); },
        [&](std::size_t i, std::size_t) { return degree[i]; }, pull);
    Shifts shifts(nodes_.size());
    for_each_node([&](std::size_t i) {
      for (std::size_t k = 0; k < K; ++k) shifts[i][k] = (fixed[i][k] + others[i][k]).imag();
    });
    return shifts;
  }

  const LinkedNodes<K>& nodes_;
  const HeldCoordinates<K>& held_;
  WholeSets sets_;
  std::vector<std::int32_t> set_of_;  // by the number of the coordinate that stands for the set
  std::vector<std::int32_t> sizes_;   // of sets: how many coordinates are held
  std::vector<SeenCoordinate> seen_;  // from a set
  std::vector<double> way_;           // to it, in sizes
};

}  // namespace

std::vector<double> whole_shifts(std::span<const std::int32_t> set_sizes, std::span<const SetGap> gaps) {
  return Shifter(set_sizes, gaps).solve();
}

template <std::size_t K>
std::vector<std::array<double, K>> whole_row_shifts(const LinkedNodes<K>& nodes, const HeldCoordinates<K>& held) {
  return RowRounding<K>(nodes, held).shifts();
}

template std::vector<std::array<double, 2>> whole_row_shifts(const LinkedNodes<2>&, const HeldCoordinates<2>&);
template std::vector<std::array<double, 3>> whole_row_shifts(const LinkedNodes<3>&, const HeldCoordinates<3>&);

}  // namespace hexpipe::tetmesh::fields
