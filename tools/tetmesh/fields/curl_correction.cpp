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
#include <cassert>
#include <numeric>
#include <utility>

#include "common/mesh/tet_mesh.hpp"
#include "common/run/parallel.hpp"
#include "tools/tetmesh/fields/loop_bundles.hpp"

namespace hexpipe::tetmesh::fields {
namespace {

// A shorter link does not become stiffer than one of this length, so that the system stays well conditioned.
constexpr float least_length = 0.1f;
constexpr double most_scale = 1.2;
constexpr std::int32_t links_in_block = 2048;
// So many blocks are summed up at the same time, because each addition waits for the one before it in its block.
constexpr std::int32_t blocks_at_once = 4;
constexpr std::int32_t links_at_once = blocks_at_once * links_in_block;
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
    stiffness_.assign(links_.size(), Values<K>::Constant(limits.stiffness));
  }

  std::vector<float> solve(std::span<const float> lengths) {
    const double missing = start(), enough = limits_.tolerance * limits_.tolerance * missing;
    iterate(missing, enough);
    for (int round = 0; round < limits_.rounds; ++round) {
      stiffen(lengths);
      if (limits_.keeps_scale) rescale();
      iterate(start(), enough);
    }
    return of_all_links();
  }

 private:
  void number_links(Bundles<K>& bundles);
  void deal_out(const Bundles<K>& bundles);
  using Products = std::array<double, blocks_at_once>;
  // The products of the numbers of links from begin to end, which are blocks_at_once blocks at most, for each block.
  // Blocks have sums of their own, so that parts and threads do not change the result.
  static Products products_of_blocks(const ValuesOfAll<K>& a, const ValuesOfAll<K>& b, std::int64_t begin,
                                     std::int64_t end) {
    using Sums = Eigen::Array<double, Values<K>::RowsAtCompileTime, 1>;
    std::array<Sums, blocks_at_once> sums;
    sums.fill(Sums::Zero());
    const auto add = [&](std::int64_t link, Sums& sum) {
      sum += a[link].template cast<double>() * b[link].template cast<double>();
    };
    if (end - begin == links_at_once) {
      for (std::int64_t link = begin; link < begin + links_in_block; ++link)
        for (std::int64_t block = 0; block < blocks_at_once; ++block) add(link + block * links_in_block, sums[block]);
    } else {
      for (std::int64_t link = begin; link < end; ++link) add(link, sums[(link - begin) / links_in_block]);
    }
    Products products;
    std::ranges::transform(sums, products.begin(), [](const Sums& sum) { return sum.sum(); });
    return products;
  }
  static double sum_after(double sum, const Products& products) {
    return std::accumulate(products.begin(), products.end(), sum);
  }
  // Calls find(begin, end) for all links in pieces, and returns the product of their numbers then, in parallel.
  template <class Find>
  double add_products(const ValuesOfAll<K>& a, const ValuesOfAll<K>& b, Find&& find) const {
    double sum = 0;
    parallel_in_order(
        static_cast<std::int64_t>(links_.size()), links_at_once,
        [&](std::int64_t begin, std::int64_t end) {
          find(begin, end);
          return products_of_blocks(a, b, begin, end);
        },
        [&](const Products& products) { sum = sum_after(sum, products); });
    return sum;
  }
  // Calls change(begin, end) for all links in pieces, in parallel.
  template <class Change>
  void change_all(Change&& change) {
    const auto all = static_cast<std::int64_t>(links_.size());
    parallel_for((all + links_at_once - 1) / links_at_once, 1, [&](std::int64_t piece) {
      change(piece * links_at_once, std::min(all, (piece + 1) * links_at_once));
    });
  }
  // Calls body(number of the vector's value) for all values of links from begin to end. They are plain floats then, of
  // which the processor changes several at once.
  template <class Body>
  static void for_each_value(std::int64_t begin, std::int64_t end, Body&& body) {
    for (std::int64_t i = values * begin; i < values * end; ++i) body(i);
  }

  template <class Body>
  void for_each_link(Body&& body) {
    change_all([&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) body(static_cast<std::size_t>(i));
    });
  }
  Values<K> distances_of(std::size_t i) const {
    Values<K> distances = Values<K>::Zero();
    for (std::size_t k = 0; k < K; ++k) distances[k] = distances_[K * static_cast<std::size_t>(links_[i]) + k];
    return distances;
  }
  // Of all distances that add up, those nearest to what is wanted are shorter in the mean, as projections are. So
  // longer ones are wanted from now on, by as much.
  void rescale() {
    double wanted = 0, found = 0;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Values<K> distances = distances_of(i);
      wanted += (distances * distances).template cast<double>().sum();
      found += (distances * (scale_ * distances + correction_[i])).template cast<double>().sum();
    }
    if (!(found > 0)) return;
    const auto scale = static_cast<float>(std::clamp(scale_ * wanted / found, 1.0, most_scale));
    for_each_link([&](std::size_t i) { correction_[i] += (scale_ - scale) * distances_of(i); });
    scale_ = scale;
  }
  // What is missing around loops, with the corrections so far, is the first direction. Returns its squared norm.
  double start() {
    for_each_link([&](std::size_t i) {
      direction_[i] = scale_ * distances_of(i) + correction_[i];
      rest_[i] = -stiffness_[i] * correction_[i];
    });
    parallel_for(static_cast<std::int64_t>(parts_.size()), 1,
                 [&](std::int64_t i) { parts_[i].template add_sums<true>(crossings_, direction_, rest_); });
    turn(0);
    return add_products(rest_, rest_, [](std::int64_t, std::int64_t) {});
  }
  // Goes on from a squared norm of the rest until it is small enough.
  void iterate(double product, double enough) {
    for (int k = 0; k < limits_.most_iterations && product > enough; ++k) {
      const auto step = static_cast<float>(product / find_image());
      const double next = advance(step);
      turn(static_cast<float>(next / product));
      product = next;
    }
  }
  // The geometric mean with the stiffness before: without it, every other round would take back what the last one did.
  void stiffen(std::span<const float> lengths) {
    for_each_link([&](std::size_t i) {
      const float length = std::max(lengths[static_cast<std::size_t>(links_[i])], least_length);
      const float soft = static_cast<float>(limits_.soft_strain) * length;
      stiffness_[i] *= (limits_.stiffness * (correction_[i].abs() / soft).max(1.0f) / stiffness_[i]).sqrt();
    });
  }
  // Returns the product of the direction and its image.
  double find_image() {
    double sum = 0;
    parallel_in_order(
        static_cast<std::int64_t>(parts_.size()), 1,
        [&](std::int64_t i, std::int64_t) {
          const LoopsOfPart<K>& part = parts_[i];
          part.template add_sums<false>(crossings_, direction_, image_);
          std::vector<Products> products;
          const auto [begin, end] = part.range();
          for (std::int32_t first = begin; first < end; first += links_at_once)
            products.push_back(products_of_blocks(direction_, image_, first, std::min(first + links_at_once, end)));
          return products;
        },
        [&](const std::vector<Products>& of_part) {
          for (const Products& products : of_part) sum = sum_after(sum, products);
        });
    return sum;
  }
  // Returns the squared norm of the rest.
  double advance(float step) {
    return add_products(rest_, rest_, [&](std::int64_t begin, std::int64_t end) {
      float *correction = correction_.data()->data(), *rest = rest_.data()->data();
      const float *direction = direction_.data()->data(), *image = image_.data()->data();
      for_each_value(begin, end, [&](std::int64_t i) { correction[i] += step * direction[i]; });
      for_each_value(begin, end, [&](std::int64_t i) { rest[i] -= step * image[i]; });
    });
  }
  // The image is to get the sums around loops, too.
  void turn(float onward) {
    change_all([&](std::int64_t begin, std::int64_t end) {
      float *direction = direction_.data()->data(), *image = image_.data()->data();
      const float *rest = rest_.data()->data(), *stiffness = stiffness_.data()->data();
      for_each_value(begin, end, [&](std::int64_t i) { direction[i] = rest[i] + onward * direction[i]; });
      for_each_value(begin, end, [&](std::int64_t i) { image[i] = stiffness[i] * direction[i]; });
    });
  }
  std::vector<float> of_all_links() const {
    std::vector<float> corrections(distances_.size());
    for (std::size_t i = 0; i < links_.size(); ++i)
      for (std::size_t k = 0; k < K; ++k)
        corrections[K * static_cast<std::size_t>(links_[i]) + k] =
            correction_[i][k] + (scale_ - 1) * distances_[K * static_cast<std::size_t>(links_[i]) + k];
    return corrections;
  }

  static constexpr std::int64_t values = Values<K>::RowsAtCompileTime;  // stored of each link

  CurlLimits limits_;
  float scale_ = 1;  // of the distances that are asked for
  std::span<const float> distances_;
  Crossings<K> crossings_;
  std::vector<std::int32_t> links_;    // those that loops lead along, ascending
  std::vector<LoopsOfPart<K>> parts_;  // one after the other
  ValuesOfAll<K> correction_, rest_, image_, direction_, stiffness_;
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
std::vector<float> curl_correction(std::span<const float> distances, const Loops& loops, const CurlLimits& limits,
                                   std::span<const float> lengths) {
  assert(limits.rounds == 0 || (limits.soft_strain > 0 && lengths.size() * K == distances.size()));
  return CurlSolver<K>(distances, loops, limits).solve(lengths);
}

template std::vector<float> curl_correction<1>(std::span<const float>, const Loops&, const CurlLimits&,
                                               std::span<const float>);
template std::vector<float> curl_correction<2>(std::span<const float>, const Loops&, const CurlLimits&,
                                               std::span<const float>);
template std::vector<float> curl_correction<3>(std::span<const float>, const Loops&, const CurlLimits&,
                                               std::span<const float>);

}  // namespace hexpipe::tetmesh::fields
