// Conjugate gradients on the normal equations. Ray, Li, Lévy, Sheffer, Alliez: Periodic global parameterization (2006),
// section 4.3, and Sokolov, Ray, Untereiner, Lévy: Hexahedral-Dominant Meshing (2016), section 4.3, correct the curl of
// a field for the same purpose, before they look for periodic coordinates along it.
//
// The time is that of reading loops and numbers from memory. Most loops lead along the same links, one loop for each
// axis, so such loops are stored together, as a bundle. Links are dealt out to parts, which work at the same time; a
// bundle whose links belong to several parts is in all of them. So each number gets the sums of its loops in the order
// of the loops, and products of vectors are summed up in blocks of links: threads and parts do not change the result.

#include "tools/tetmesh/fields/curl_correction.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "common/mesh/tet_mesh.hpp"
#include "common/run/parallel.hpp"
#include "tools/tetmesh/fields/loop_bundles.hpp"

namespace hexpipe::tetmesh::fields {
namespace {

constexpr std::int32_t links_in_block = 2048;
// Loops are cut into parts of at least this many blocks of links, and into twice as many parts as there are threads.
// There are no parts where too large a share of the bundles would be in several, as where neighbours have numbers far
// apart.
constexpr std::int32_t least_part = 8, most_parts = 16;
constexpr double most_repeated = 0.4;

template <std::size_t K>
class CurlSolver {
 public:
  CurlSolver(std::span<const float> distances, const Loops& loops, const CurlLimits& limits)
      : limits_(limits), distances_(distances) {
    Bundles<K> bundles;
    bundles.add(loops);
    number_links(bundles);
    deal_out(bundles);
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
  void number_links(Bundles<K>& bundles);
  void deal_out(const Bundles<K>& bundles);
  // Calls find(link) for the links from begin to end, and returns the product of their numbers then. Blocks of links
  // have sums of their own, so that parts and threads do not change the result.
  template <class Find>
  static double product_of_block(const ValuesOfAll<K>& a, const ValuesOfAll<K>& b, std::int64_t begin, std::int64_t end,
                                 Find&& find) {
    using Sums = Eigen::Array<double, Values<K>::RowsAtCompileTime, 1>;
    Sums sums = Sums::Zero();
    for (std::int64_t link = begin; link < end; ++link) {
      find(link);
      sums += a[link].template cast<double>() * b[link].template cast<double>();
    }
    return sums.sum();
  }
  // The same for all links, in parallel.
  template <class Find>
  double add_products(const ValuesOfAll<K>& a, const ValuesOfAll<K>& b, Find&& find) const {
    double sum = 0;
    parallel_in_order(
        static_cast<std::int64_t>(links_.size()), links_in_block,
        [&](std::int64_t begin, std::int64_t end) { return product_of_block(a, b, begin, end, find); },
        [&](double product) { sum += product; });
    return sum;
  }
  template <class Body>
  void for_each_link(Body&& body) {
    parallel_for(static_cast<std::int64_t>(links_.size()), links_in_block, body);
  }

  // What is missing around loops is the first direction.
  void start() {
    for (std::size_t i = 0; i < links_.size(); ++i)
      for (std::size_t k = 0; k < K; ++k) direction_[i][k] = distances_[K * static_cast<std::size_t>(links_[i]) + k];
    parallel_for(static_cast<std::int64_t>(parts_.size()), 1,
                 [&](std::int64_t i) { parts_[i].template add_sums<true>(crossings_, direction_, rest_); });
    for_each_link([&](std::int64_t link) { set_direction(link, rest_[link]); });
  }
  // The image is to get the sums around loops, too.
  void set_direction(std::int64_t link, const Values<K>& direction) {
    direction_[link] = direction;
    image_[link] = limits_.stiffness * direction;
  }
  // Returns the product of the direction and its image.
  double find_image() {
    double sum = 0;
    parallel_in_order(
        static_cast<std::int64_t>(parts_.size()), 1,
        [&](std::int64_t i, std::int64_t) {
          const LoopsOfPart<K>& part = parts_[i];
          part.template add_sums<false>(crossings_, direction_, image_);
          std::vector<double> products;
          const auto [begin, end] = part.range();
          for (std::int32_t block = begin; block < end; block += links_in_block)
            products.push_back(product_of_block(direction_, image_, block, std::min(block + links_in_block, end),
                                                [](std::int64_t) {}));
          return products;
        },
        [&](const std::vector<double>& products) { sum = std::accumulate(products.begin(), products.end(), sum); });
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
    for_each_link([&](std::int64_t link) { set_direction(link, rest_[link] + onward * direction_[link]); });
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
  std::vector<std::int32_t> links_;    // those that loops lead along, ascending
  std::vector<LoopsOfPart<K>> parts_;  // one after the other
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
void CurlSolver<K>::deal_out(const Bundles<K>& bundles) {
  const auto all = static_cast<std::int32_t>(links_.size());
  const std::int32_t blocks = (all + links_in_block - 1) / links_in_block;
  std::int32_t count =
      thread_count() == 1 ? 1 : std::clamp(blocks / least_part, 1, std::min(2 * thread_count(), most_parts));
  std::vector<std::int32_t> part_of_block(static_cast<std::size_t>(blocks));
  for (std::int32_t block = 0; block < blocks; ++block)
    part_of_block[block] = static_cast<std::int32_t>(std::int64_t{block} * count / blocks);
  const auto part_of = [&](std::int32_t link) { return part_of_block[link / links_in_block]; };
  // Calls body(bundle, part) for each part that one of its links belongs to.
  const auto for_each_part = [&](auto&& body) {
    std::array<std::size_t, most_parts> seen_in;
    seen_in.fill(bundles.size());
    for (std::size_t i = 0; i < bundles.size(); ++i)
      for (const std::int32_t link : bundles.links_of(i))
        if (std::exchange(seen_in[part_of(link)], i) != i) body(i, part_of(link));
  };
  std::size_t dealt = 0;
  for_each_part([&](std::size_t, std::int32_t) { ++dealt; });
  if (static_cast<double>(dealt) > (1 + most_repeated) * static_cast<double>(bundles.size())) {
    count = 1;
    std::ranges::fill(part_of_block, 0);
  }
  std::vector<LinkRange> ranges(static_cast<std::size_t>(count));
  for (std::int32_t block = 0; block < blocks; ++block)
    ranges[part_of_block[block]].end = std::min(all, (block + 1) * links_in_block);
  for (std::size_t part = 1; part < ranges.size(); ++part) ranges[part].begin = ranges[part - 1].end;
  for (const LinkRange& range : ranges) parts_.emplace_back(range);
  for_each_part([&](std::size_t bundle, std::int32_t part) { parts_[part].add(bundles, bundle); });
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
