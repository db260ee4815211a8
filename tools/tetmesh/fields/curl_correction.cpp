// Conjugate gradients on the normal equations. Ray, Li, Lévy, Sheffer, Alliez: Periodic global parameterization (2006),
// section 4.3, and Sokolov, Ray, Untereiner, Lévy: Hexahedral-Dominant Meshing (2016), section 4.3, correct the curl of
// a field for the same purpose, before they look for periodic coordinates along it.
//
// The time is that of reading loops and numbers from memory. Most loops lead along the same links, one loop for each
// axis, so such loops are stored together, as a bundle. Links are dealt out to parts, which work at the same time; a
// bundle whose links belong to several parts is in all of them. So each number gets the sums of its loops in the order
// of the loops, and products of vectors are summed up in the order of the numbers: threads do not change the result.

#include "tools/tetmesh/fields/curl_correction.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>

#include "common/mesh/tet_mesh.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::tetmesh::fields {
namespace {

// The K numbers of a link or a bundle, at places that the processor reads and adds at once. Single precision is enough
// for the tolerance, and the speed depends on the amount of memory that is read.
template <std::size_t K>
using Values = Eigen::Array<float, K == 3 ? 4 : K, 1>;
template <std::size_t K>
using ValuesOfAll = std::vector<Values<K>>;

constexpr std::int64_t links_in_block = 2048;
// Loops are cut into parts of at least this many links. There are no parts where too large a share of the bundles would
// be in several, as where neighbours have numbers far apart.
constexpr std::size_t least_part = 16384, most_parts = 8;
constexpr double most_repeated = 0.4;

bool is_backwards(std::int32_t step) {
  return step < 0;
}
std::int32_t number_of(std::int32_t step) {
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

// The ways in which a bundle can cross a link, by their codes. Codes from `bundled` on are those of a loop by itself,
// which is value 0 of its bundle and crosses one number.
template <std::size_t K>
class Crossings {
 public:
  static constexpr std::size_t senses = 1 << K, bundled = (K == 3 ? 6 : K) * senses;

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
    if (is_plain(code)) return sign_of_plain(code) * numbers;
    if (code < bundled) return numbers_of_loops_[code].of(numbers);
    Values<K> seen = Values<K>::Zero();
    seen[0] = sign_of_one(code) * numbers[axis_of_one(code)];
    return seen;
  }
  Values<K> seen_by_numbers(std::uint8_t code, const Values<K>& sums) const {
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

  std::array<Match<K>, bundled> numbers_of_loops_, loops_of_numbers_;
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

  // Adds the sums of the numbers along all loops to the images of those links from begin to end that they lead along.
  // With `lacking`, it adds what the sums lack.
  template <bool lacking>
  void add_sums(const Crossings<K>& crossings, const ValuesOfAll<K>& numbers, std::int32_t begin, std::int32_t end,
                ValuesOfAll<K>& images) const;

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
template <bool lacking>
void Bundles<K>::add_sums(const Crossings<K>& crossings, const ValuesOfAll<K>& numbers, std::int32_t begin,
                          std::int32_t end, ValuesOfAll<K>& images) const {
  for (std::size_t bundle = 0; bundle < size(); ++bundle) {
    Values<K> sum = Values<K>::Zero();
    const std::int64_t first = ends_[bundle], last = ends_[bundle + 1];
    for (std::int64_t s = first; s < last; ++s) sum += crossings.seen_by_loops(codes_[s], numbers[links_[s]]);
    if constexpr (lacking) sum = wanted_[bundle] - sum;
    for (std::int64_t s = first; s < last; ++s)
      if (links_[s] >= begin && links_[s] < end) images[links_[s]] += crossings.seen_by_numbers(codes_[s], sum);
  }
}

template <std::size_t K>
class CurlSolver {
 public:
  CurlSolver(std::span<const float> distances, const Loops& loops, const CurlLimits& limits)
      : limits_(limits), distances_(distances) {
    Bundles<K> bundles;
    bundles.add(loops);
    number_links(bundles);
    deal_out(std::move(bundles));
    correction_.assign(links_.size(), Values<K>::Zero());
    rest_ = image_ = direction_ = correction_;
  }

  std::vector<float> solve() {
    start();
    double product = add_products(rest_, rest_, [](std::int64_t) {});
    const double enough = limits_.tolerance * limits_.tolerance * product;
    for (int k = 0; k < limits_.most_iterations && product > enough; ++k) {
      const auto step = static_cast<float>(product / find_image());
      const double next = advance(step);
      turn(static_cast<float>(next / product));
      product = next;
    }
    return of_all_links();
  }

 private:
  // The links from begin to end, and all loops that lead along them.
  struct Part {
    std::int32_t begin, end;
    Bundles<K> bundles;
  };

  void number_links(Bundles<K>& bundles);
  void deal_out(Bundles<K>&& bundles);
  double product_of(const ValuesOfAll<K>& a, const ValuesOfAll<K>& b, double before, std::int64_t begin,
                    std::int64_t end) const {
    double sum = before;
    for (std::int64_t link = begin; link < end; ++link)
      for (std::size_t k = 0; k < K; ++k) sum += static_cast<double>(a[link][k]) * b[link][k];
    return sum;
  }
  // Calls find(link) for all links in parallel, and adds up the products of their numbers in order.
  template <class Find>
  double add_products(const ValuesOfAll<K>& a, const ValuesOfAll<K>& b, Find&& find) const {
    double sum = 0;
    parallel_in_order(
        static_cast<std::int64_t>(links_.size()), links_in_block,
        [&](std::int64_t begin, std::int64_t end) {
          for (std::int64_t link = begin; link < end; ++link) find(link);
          return std::pair(begin, end);
        },
        [&](const std::pair<std::int64_t, std::int64_t>& block) {
          sum = product_of(a, b, sum, block.first, block.second);
        });
    return sum;
  }

  // What is missing around loops is the first direction.
  void start() {
    for (std::size_t i = 0; i < links_.size(); ++i)
      for (std::size_t k = 0; k < K; ++k) direction_[i][k] = distances_[K * static_cast<std::size_t>(links_[i]) + k];
    parallel_for(static_cast<std::int64_t>(parts_.size()), 1, [&](std::int64_t i) {
      const Part& part = parts_[i];
      part.bundles.template add_sums<true>(crossings_, direction_, part.begin, part.end, rest_);
    });
    direction_ = rest_;
  }
  // Returns the product of the direction and its image.
  double find_image() {
    double sum = 0;
    parallel_in_order(
        static_cast<std::int64_t>(parts_.size()), 1,
        [&](std::int64_t i, std::int64_t) {
          const Part& part = parts_[i];
          for (std::int32_t link = part.begin; link < part.end; ++link)
            image_[link] = limits_.stiffness * direction_[link];
          part.bundles.template add_sums<false>(crossings_, direction_, part.begin, part.end, image_);
          return &part;
        },
        [&](const Part* part) { sum = product_of(direction_, image_, sum, part->begin, part->end); });
    return sum;
  }
  // Returns the squared norm of the rest.
  double advance(float step) {
    return add_products(rest_, rest_, [&](std::int64_t link) {
      correction_[link] += step * direction_[link];
      rest_[link] -= step * image_[link];
    });
  }
  void turn(float onward) {
    parallel_for(static_cast<std::int64_t>(links_.size()), links_in_block,
                 [&](std::int64_t link) { direction_[link] = rest_[link] + onward * direction_[link]; });
  }
  std::vector<float> of_all_links() const {
    std::vector<float> corrections(distances_.size());
    for (std::size_t i = 0; i < links_.size(); ++i)
      for (std::size_t k = 0; k < K; ++k) corrections[K * static_cast<std::size_t>(links_[i]) + k] = correction_[i][k];
    return corrections;
  }

  CurlLimits limits_;
  std::span<const float> distances_;
  Crossings<K> crossings_;
  std::vector<std::int32_t> links_;  // those that loops lead along, ascending
  std::vector<Part> parts_;          // one after the other
  ValuesOfAll<K> correction_, rest_, image_, direction_;
};

// The others have no numbers here.
template <std::size_t K>
void CurlSolver<K>::number_links(Bundles<K>& bundles) {
  std::vector<std::int32_t> number(distances_.size() / K, no_index);
  for (const std::int32_t link : bundles.all_links()) number[link] = 0;
  for (std::int32_t link = 0; link < static_cast<std::int32_t>(number.size()); ++link) {
    if (number[link] == no_index) continue;
    number[link] = static_cast<std::int32_t>(links_.size());
    links_.push_back(link);
  }
  bundles.number_links(number);
}

template <std::size_t K>
void CurlSolver<K>::deal_out(Bundles<K>&& bundles) {
  const std::size_t count = std::clamp<std::size_t>(links_.size() / least_part, 1, most_parts);
  const auto part_of = [&](std::int32_t link) { return static_cast<std::size_t>(link) * count / links_.size(); };
  // Calls body(bundle, part) for each part that one of its links belongs to.
  const auto for_each_part = [&](auto&& body) {
    std::array<std::size_t, most_parts> seen_in;
    seen_in.fill(bundles.size());
    for (std::size_t i = 0; i < bundles.size(); ++i)
      for (const std::int32_t link : bundles.links_of(i))
        if (std::exchange(seen_in[part_of(link)], i) != i) body(i, part_of(link));
  };
  std::size_t dealt = 0;
  for_each_part([&](std::size_t, std::size_t) { ++dealt; });
  const auto all = static_cast<std::int32_t>(links_.size());
  if (count == 1 || static_cast<double>(dealt) > (1 + most_repeated) * static_cast<double>(bundles.size())) {
    parts_.push_back({0, all, std::move(bundles)});
    return;
  }
  parts_.resize(count);
  for (std::int32_t link = 0; link < all; ++link) parts_[part_of(link)].end = link + 1;
  for (std::size_t part = 1; part < count; ++part) parts_[part].begin = parts_[part - 1].end;
  for_each_part([&](std::size_t bundle, std::size_t part) { parts_[part].bundles.add(bundles, bundle); });
}

}  // namespace

template <std::size_t K>
std::vector<float> curl_correction(std::span<const float> distances, const Loops& loops, const CurlLimits& limits) {
  return CurlSolver<K>(distances, loops, limits).solve();
}

template std::vector<float> curl_correction<1>(std::span<const float>, const Loops&, const CurlLimits&);
template std::vector<float> curl_correction<2>(std::span<const float>, const Loops&, const CurlLimits&);
template std::vector<float> curl_correction<3>(std::span<const float>, const Loops&, const CurlLimits&);

}  // namespace hexpipe::tetmesh::fields
