#pragma once
// Loops over links with K numbers each, stored so that their sums are read at the speed of memory: K loops along the
// same links, one for each number, are a bundle. Most loops are bundles, most bundles plain triangles, and of the
// others nearly all have one step: these are no loops to go along, but counts and sums at their numbers. Where a
// singularity pierces a triangle, only one number has a loop.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "tools/tetmesh/fields/loops.hpp"

namespace hexpipe::tetmesh::fields {

// The K numbers of a link or a bundle, at places that the processor reads and adds at once. Single precision is enough
// for the tolerance, and the speed depends on the amount of memory that is read.
template <std::size_t K>
using Values = Eigen::Array<float, K == 3 ? 4 : K, 1>;
template <std::size_t K>
using ValuesOfAll = std::vector<Values<K>>;

inline bool is_backwards(std::int32_t step) {
  return step < 0;
}
inline std::int32_t number_of(std::int32_t step) {
  return step < 0 ? ~step : step;
}
template <std::size_t K>
std::int32_t link_of(std::int32_t step) {
  return number_of(step) / static_cast<std::int32_t>(K);
}

// How K values on one side of a link correspond to K values on the other: value k to value axis[k] times sign[k].
template <std::size_t K>
struct Match {
  std::array<std::uint8_t, K> axis{};
  std::array<float, K> sign{};

  Values<K> of(const Values<K>& values) const {
    Values<K> result = Values<K>::Zero();
    for (std::size_t k = 0; k < K; ++k) result[k] = sign[k] * values[axis[k]];
    return result;
  }
};

// The same for two values, as operations on their bits. There is no order in the ways in which links of a surface are
// crossed, so a branch for them would be guessed wrong every other time.
struct BitMatch {
  std::uint64_t kept = 0, flipped = 0;
  int turn = 0;

  // Value k comes from axis[k], or is 0 where there is none.
  static BitMatch of_signs(const std::array<std::optional<std::uint8_t>, 2>& axis, const std::array<float, 2>& sign) {
    BitMatch match;
    std::array<std::uint32_t, 2> kept{}, flipped{};
    for (std::size_t k = 0; k < 2; ++k) {
      if (!axis[k]) continue;
      kept[k] = ~std::uint32_t{0};
      flipped[k] = sign[k] < 0 ? std::uint32_t{1} << 31 : 0;
      if (*axis[k] != k) match.turn = 32;
    }
    match.kept = std::bit_cast<std::uint64_t>(kept);
    match.flipped = std::bit_cast<std::uint64_t>(flipped);
    return match;
  }
  Values<2> of(const Values<2>& values) const {
    std::uint64_t bits;
    std::memcpy(&bits, values.data(), sizeof bits);
    bits = (std::rotl(bits, turn) & kept) ^ flipped;
    Values<2> result;
    std::memcpy(result.data(), &bits, sizeof bits);
    return result;
  }
};

// The ways in which a bundle can cross a link, by their codes. Codes from `bundled` on are those of a loop by itself,
// which is value 0 of its bundle and crosses one number.
template <std::size_t K>
class Crossings {
 public:
  static constexpr std::size_t senses = 1 << K, bundled = (K == 3 ? 6 : K) * senses, codes = bundled + 2 * K;

  Crossings() {
    std::array<std::uint8_t, K> order;
    std::iota(order.begin(), order.end(), std::uint8_t{0});
    for (std::size_t code = 0; code < bundled; ++code) {
      if (code > 0 && code % senses == 0) std::ranges::next_permutation(order);
      for (std::size_t k = 0; k < K; ++k) {
        const float sign = (code >> k & 1) != 0 ? -1.0f : 1.0f;
        numbers_of_loops_[code].axis[k] = order[k];
        numbers_of_loops_[code].sign[k] = sign;
        loops_of_numbers_[code].axis[order[k]] = static_cast<std::uint8_t>(k);
        loops_of_numbers_[code].sign[order[k]] = sign;
      }
    }
    if constexpr (K == 2) match_bits();
  }

  // The code of a bundle whose loops take these steps, if they cross all numbers of one link.
  static std::optional<std::uint8_t> code_of(const std::array<std::int32_t, K>& steps) {
    std::array<std::size_t, K> axes;
    std::size_t code = 0;
    for (std::size_t k = 0; k < K; ++k) {
      if (link_of<K>(steps[k]) != link_of<K>(steps[0])) return std::nullopt;
      axes[k] = static_cast<std::size_t>(number_of(steps[k])) % K;
      if (is_backwards(steps[k])) code |= std::size_t{1} << k;
    }
    // The number of the permutation in lexicographic order.
    std::size_t order = 0;
    for (std::size_t k = 0; k < K; ++k) {
      std::size_t smaller = 0;
      for (std::size_t l = k + 1; l < K; ++l) {
        if (axes[l] == axes[k]) return std::nullopt;
        smaller += axes[l] < axes[k] ? 1 : 0;
      }
      order = order * (K - k) + smaller;
    }
    return static_cast<std::uint8_t>(order * senses + code);
  }
  static std::uint8_t code_of_one(std::int32_t step) {
    return static_cast<std::uint8_t>(bundled + 2 * (static_cast<std::size_t>(number_of(step)) % K) +
                                     (is_backwards(step) ? 1 : 0));
  }
  // What the loops of a bundle see of the numbers of a link, and what the numbers see of the loops. Most crossings
  // match value k to value k, all with one sign.
  Values<K> seen_by_loops(std::uint8_t code, const Values<K>& numbers) const {
    if constexpr (K == 2) return bits_of_loops_[code].of(numbers);
    if (is_plain(code)) return sign_of_plain(code) * numbers;
    if (code < bundled) return numbers_of_loops_[code].of(numbers);
    Values<K> seen = Values<K>::Zero();
    seen[0] = sign_of_one(code) * numbers[axis_of_one(code)];
    return seen;
  }
  Values<K> seen_by_numbers(std::uint8_t code, const Values<K>& sums) const {
    if constexpr (K == 2) return bits_of_numbers_[code].of(sums);
    if (is_plain(code)) return sign_of_plain(code) * sums;
    if (code < bundled) return loops_of_numbers_[code].of(sums);
    Values<K> seen = Values<K>::Zero();
    seen[axis_of_one(code)] = sign_of_one(code) * sums[0];
    return seen;
  }

 private:
  static bool is_plain(std::uint8_t code) { return code == 0 || code == senses - 1; }
  static float sign_of_plain(std::uint8_t code) { return code == 0 ? 1.0f : -1.0f; }
  static std::size_t axis_of_one(std::uint8_t code) { return (code - bundled) / 2; }
  static float sign_of_one(std::uint8_t code) { return (code - bundled) % 2 != 0 ? -1.0f : 1.0f; }
  void match_bits() {
    for (std::uint8_t code = 0; code < codes; ++code) {
      std::array<std::optional<std::uint8_t>, 2> loops, numbers;
      std::array<float, 2> sign_of_loops{}, sign_of_numbers{};
      if (code < bundled) {
        std::ranges::copy(numbers_of_loops_[code].axis, loops.begin());
        std::ranges::copy(loops_of_numbers_[code].axis, numbers.begin());
        sign_of_loops = numbers_of_loops_[code].sign;
        sign_of_numbers = loops_of_numbers_[code].sign;
      } else {
        const std::size_t axis = axis_of_one(code);
        loops[0] = static_cast<std::uint8_t>(axis);
        numbers[axis] = std::uint8_t{0};
        sign_of_loops[0] = sign_of_numbers[axis] = sign_of_one(code);
      }
      bits_of_loops_[code] = BitMatch::of_signs(loops, sign_of_loops);
      bits_of_numbers_[code] = BitMatch::of_signs(numbers, sign_of_numbers);
    }
  }

  std::array<Match<K>, bundled> numbers_of_loops_, loops_of_numbers_;
  std::array<BitMatch, K == 2 ? codes : 0> bits_of_loops_, bits_of_numbers_;
};

constexpr std::int32_t links_in_block = 2048;

// The links from begin, which begins a block, to end.
struct LinkRange {
  std::int32_t begin = 0, end = 0;

  bool has(std::int32_t link) const { return link >= begin && link < end; }
};

// The squares of the sums of bundles, for each block of a range of links those of bundles whose first link is in it.
// They are added up in the order of the bundles, so they do not depend on what else is in the range.
template <std::size_t K>
class SquaresByBlock {
 public:
  explicit SquaresByBlock(const LinkRange& range)
      : range_(range), sums_(static_cast<std::size_t>(range.end - range.begin) / links_in_block + 1, Sums::Zero()) {}

  void add(std::int32_t first_link, const Values<K>& sum) {
    if (!range_.has(first_link)) return;
    const std::int32_t block = (first_link - range_.begin) / links_in_block;
    if (block != block_) {
      sums_[block_] = sum_;
      sum_ = sums_[block];
      block_ = block;
    }
    sum_ += sum.square().template cast<double>();
  }
  std::vector<double> of_blocks() {
    sums_[block_] = sum_;
    std::vector<double> result;
    for (const Sums& sums : sums_) result.push_back(sums.sum());
    return result;
  }

 private:
  using Sums = Eigen::Array<double, Values<K>::RowsAtCompileTime, 1>;

  LinkRange range_;
  std::vector<Sums> sums_;
  std::int32_t block_ = 0;  // the one that grows
  Sums sum_ = Sums::Zero();
};

// Loops over links with K numbers each.
template <std::size_t K>
class Bundles {
 public:
  static constexpr std::size_t longest = 32;  // in links

  void add(const Loops& loops) {
    for (std::size_t i = 0; i < loops.size();) i += add_bundle(loops, i) ? K : add_one(loops, i);
  }
  // Appends a bundle of others.
  void add(const Bundles& others, std::size_t bundle) {
    for (std::int64_t s = others.ends_[bundle]; s < others.ends_[bundle + 1]; ++s) {
      links_.push_back(others.links_[s]);
      codes_.push_back(others.codes_[s]);
    }
    close(others.wanted_[bundle]);
  }
  std::size_t size() const { return wanted_.size(); }
  std::span<const std::int32_t> links_of(std::size_t bundle) const {
    return std::span(links_).subspan(ends_[bundle], ends_[bundle + 1] - ends_[bundle]);
  }
  // Numbers the links anew.
  void number_links(const std::vector<std::int32_t>& number) {
    for (std::int32_t& link : links_) link = number[link];
  }
  std::span<const std::int32_t> all_links() const { return links_; }
  // Whether the bundle leads along two links onwards and along the third one back, every value meets itself, and the
  // sums are 0.
  bool is_plain_triangle(std::size_t bundle) const {
    constexpr std::array<std::uint8_t, 3> plain{0, 0, Crossings<K>::senses - 1};
    const auto codes = std::span(codes_).subspan(ends_[bundle], ends_[bundle + 1] - ends_[bundle]);
    return std::ranges::equal(codes, plain) && (wanted_[bundle] == 0).all();
  }

  bool has_one_step(std::size_t bundle) const { return ends_[bundle + 1] - ends_[bundle] == 1; }
  // Adds a bundle of one step to the loops along each number of its link alone, and what it asks for to their sums.
  void add_one_step(const Crossings<K>& crossings, std::size_t bundle, ValuesOfAll<K>& loops,
                    ValuesOfAll<K>& sums) const {
    const std::uint32_t step = ends_[bundle];
    Values<K> one = Values<K>::Zero();
    one.template head<K>() = 1;
    loops[links_[step]] += crossings.seen_by_numbers(codes_[step], one).abs();
    sums[links_[step]] += crossings.seen_by_numbers(codes_[step], wanted_[bundle]);
  }

  // Adds the sums of the numbers along the loops of bundles to the images of those links in `range` that they lead
  // along, or what these sums lack. Calls told(first link, sums) for each bundle.
  template <bool lacking, class Told>
  void add_sums(const Crossings<K>& crossings, std::size_t first, std::size_t last, const LinkRange& range,
                const ValuesOfAll<K>& numbers, ValuesOfAll<K>& images, Told&& told) const;

 private:
  bool add_bundle(const Loops& loops, std::size_t first);
  std::size_t add_one(const Loops& loops, std::size_t loop);
  void close(const Values<K>& wanted) {
    ends_.push_back(static_cast<std::uint32_t>(links_.size()));
    wanted_.push_back(wanted);
  }

  std::vector<std::uint32_t> ends_{0};  // of each bundle's steps
  std::vector<std::int32_t> links_;     // of each step
  std::vector<std::uint8_t> codes_;     // of each step
  ValuesOfAll<K> wanted_;               // the sums of each bundle
};

// Adds K loops if they lead along the same links, over different numbers, and over no link twice: then the order of
// loops at a number is that of bundles.
template <std::size_t K>
bool Bundles<K>::add_bundle(const Loops& loops, std::size_t first) {
  if (first + K > loops.size()) return false;
  const std::size_t length = loops[first].size(), before = links_.size();
  for (std::size_t k = 0; k < K; ++k)
    if (loops[first + k].size() != length || length > longest) return false;
  const auto give_up = [&] {
    links_.resize(before);
    codes_.resize(before);
    return false;
  };
  for (std::size_t s = 0; s < length; ++s) {
    std::array<std::int32_t, K> steps;
    for (std::size_t k = 0; k < K; ++k) steps[k] = loops[first + k][s];
    const auto code = Crossings<K>::code_of(steps);
    const std::int32_t link = link_of<K>(steps[0]);
    const auto begin = links_.begin() + static_cast<std::ptrdiff_t>(before);
    if (!code || std::find(begin, links_.end(), link) != links_.end()) return give_up();
    links_.push_back(link);
    codes_.push_back(*code);
  }
  Values<K> wanted = Values<K>::Zero();
  for (std::size_t k = 0; k < K; ++k) wanted[k] = loops.sum_of(first + k);
  close(wanted);
  return true;
}

template <std::size_t K>
std::size_t Bundles<K>::add_one(const Loops& loops, std::size_t loop) {
  for (const std::int32_t step : loops[loop]) {
    links_.push_back(link_of<K>(step));
    codes_.push_back(Crossings<K>::code_of_one(step));
  }
  Values<K> wanted = Values<K>::Zero();
  wanted[0] = loops.sum_of(loop);
  close(wanted);
  return 1;
}

template <std::size_t K>
template <bool lacking, class Told>
void Bundles<K>::add_sums(const Crossings<K>& crossings, std::size_t first, std::size_t last, const LinkRange& range,
                          const ValuesOfAll<K>& numbers, ValuesOfAll<K>& images, Told&& told) const {
  for (std::size_t bundle = first; bundle < last; ++bundle) {
    Values<K> sum = Values<K>::Zero();
    const std::int64_t begin = ends_[bundle], end = ends_[bundle + 1];
    assert(begin < end);
    for (std::int64_t s = begin; s < end; ++s) sum += crossings.seen_by_loops(codes_[s], numbers[links_[s]]);
    if constexpr (lacking) sum = wanted_[bundle] - sum;
    told(links_[begin], sum);
    for (std::int64_t s = begin; s < end; ++s)
      if (range.has(links_[s])) images[links_[s]] += crossings.seen_by_numbers(codes_[s], sum);
  }
}

// The loops that lead along a range of links, in their order. Most are plain triangles; they are stored as their links
// alone, which takes half of the memory and less time.
template <std::size_t K>
class LoopsOfPart {
 public:
  explicit LoopsOfPart(const LinkRange& range) : range_(range) {}

  void add(const Bundles<K>& bundles, std::size_t bundle) {
    if (bundles.is_plain_triangle(bundle)) {
      const auto links = bundles.links_of(bundle);
      triangles_.push_back({links[0], links[1], links[2]});
      if (ends_.empty() || ends_.back().others < others_.size()) ends_.push_back({0, others_.size()});
      ends_.back().triangles = triangles_.size();
    } else {
      others_.add(bundles, bundle);
    }
  }

  // Adds the sums of the numbers along loops to the images of the range's links. Returns the sums of their squares, a
  // bundle's for the block of its first link.
  std::vector<double> add_sums(const Crossings<K>& crossings, const ValuesOfAll<K>& numbers,
                               ValuesOfAll<K>& images) const {
    SquaresByBlock<K> squares(range_);
    add<false>(crossings, numbers, images, [&](std::int32_t link, const Values<K>& sum) { squares.add(link, sum); });
    return squares.of_blocks();
  }
  // Adds what the sums lack.
  void add_lacking(const Crossings<K>& crossings, const ValuesOfAll<K>& numbers, ValuesOfAll<K>& images) const {
    add<true>(crossings, numbers, images, [](std::int32_t, const Values<K>&) {});
  }

 private:
  template <bool lacking, class Told>
  void add(const Crossings<K>& crossings, const ValuesOfAll<K>& numbers, ValuesOfAll<K>& images, Told&& told) const {
    std::size_t triangle = 0, other = 0;
    for (const Ends& ends : ends_) {
      others_.template add_sums<lacking>(crossings, other, ends.others, range_, numbers, images, told);
      other = ends.others;
      for (; triangle < ends.triangles; ++triangle) {
        const auto& [first, second, back] = triangles_[triangle];
        Values<K> sum = numbers[first] + numbers[second] - numbers[back];
        if constexpr (lacking) sum = -sum;
        told(first, sum);
        if (range_.has(first)) images[first] += sum;
        if (range_.has(second)) images[second] += sum;
        if (range_.has(back)) images[back] -= sum;
      }
    }
    others_.template add_sums<lacking>(crossings, other, others_.size(), range_, numbers, images, told);
  }

  // Other bundles and then triangles up to these numbers follow those before.
  struct Ends {
    std::size_t triangles, others;
  };

  LinkRange range_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
  Bundles<K> others_;
  std::vector<Ends> ends_;
};

}  // namespace hexpipe::tetmesh::fields
