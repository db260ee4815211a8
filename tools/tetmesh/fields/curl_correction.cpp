// Conjugate gradients on the normal equations. Ray, Li, Lévy, Sheffer, Alliez: Periodic global parameterization (2006),
// section 4.3, and Sokolov, Ray, Untereiner, Lévy: Hexahedral-Dominant Meshing (2016), section 4.3, correct the curl of
// a field for the same purpose, before they look for periodic coordinates along it.
//
// The time is that of reading loops and numbers from memory. So loops are stored as loop_bundles.hpp says, and an
// iteration reads all numbers three times: it turns the direction, adds up the loops along it, and goes along it. Links
// are dealt out to parts, which work at the same time; a bundle whose links belong to several parts is in all of them.
// So each number gets what loops along it alone ask for, then the sums of the others in the order of the loops, and
// products are summed up in pieces of a fixed size: threads and parts do not change the result.

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
// So many floats are changed at once.
using Packet = Eigen::Array4f;
constexpr std::int64_t floats_in_packet = Packet::RowsAtCompileTime;
constexpr std::int64_t packets_in_piece = 4096;
// Loops are cut into parts of at least this many blocks of links, one for each thread: the more parts, the more bundles
// are in several. There are no parts where too large a share of the bundles would be, as where neighbours have numbers
// far apart.
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
    correction_ = rest_ = image_ = direction_ = weight_ = own_loops_ = own_sums_ = constants(0);
    deal_out(bundles);
    stiffness_ = constants(limits.stiffness);
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
  // A number for each value of each link, and some more that are 0, up to whole packets.
  ValuesOfAll<K> constants(float value) const {
    constexpr std::size_t links_in_packets = K == 3 ? 1 : floats_in_packet / K;
    ValuesOfAll<K> numbers(links_.size(), Values<K>::Constant(value));
    numbers.resize((links_.size() + links_in_packets - 1) / links_in_packets * links_in_packets, Values<K>::Zero());
    return numbers;
  }
  static auto packet(ValuesOfAll<K>& numbers, std::int64_t i) {
    return Eigen::Map<Packet>(numbers.data()->data() + floats_in_packet * i);
  }
  // Calls change(i) for all packets, in parallel, and returns the sum of the numbers that come back.
  template <class Change>
  double sum_of_packets(Change&& change) {
    double sum = 0;
    parallel_in_order(
        static_cast<std::int64_t>(direction_.size()) * Values<K>::RowsAtCompileTime / floats_in_packet,
        packets_in_piece,
        [&](std::int64_t begin, std::int64_t end) {
          // Two sums, because each addition waits for the one before it.
          std::array<Eigen::Array4d, 2> sums{Eigen::Array4d::Zero(), Eigen::Array4d::Zero()};
          std::int64_t i = begin;
          for (; i + 1 < end; i += 2) {
            sums[0] += change(i).template cast<double>();
            sums[1] += change(i + 1).template cast<double>();
          }
          if (i < end) sums[0] += change(i).template cast<double>();
          return (sums[0] + sums[1]).sum();
        },
        [&](double of_piece) { sum += of_piece; });
    return sum;
  }

  template <class Body>
  void for_each_link(Body&& body) {
    parallel_for(static_cast<std::int64_t>(links_.size()), links_in_block,
                 [&](std::int64_t i) { body(static_cast<std::size_t>(i)); });
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
  // Begins with what is missing around loops, with the corrections so far. Returns its squared norm.
  double start() {
    for_each_link([&](std::size_t i) {
      direction_[i] = scale_ * distances_of(i) + correction_[i];
      rest_[i] = own_sums_[i] - own_loops_[i] * direction_[i] - stiffness_[i] * correction_[i];
      weight_[i] = stiffness_[i] + own_loops_[i];
    });
    parallel_for(static_cast<std::int64_t>(parts_.size()), 1,
                 [&](std::int64_t i) { parts_[i].add_lacking(crossings_, direction_, rest_); });
    return sum_of_packets([&](std::int64_t i) -> Packet { return packet(rest_, i).square(); });
  }
  // Goes on from a squared norm of the rest until it is small enough.
  void iterate(double product, double enough) {
    float onward = 0;
    for (int k = 0; k < limits_.most_iterations && product > enough; ++k) {
      const double bend = turn(onward) + add_loops();
      const double next = advance(static_cast<float>(product / bend));
      onward = static_cast<float>(next / product);
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
  // Turns the direction to the rest, and begins its image: what it would be without loops along more than one number.
  // Returns the product of the two.
  double turn(float onward) {
    return sum_of_packets([&](std::int64_t i) -> Packet {
      auto direction = packet(direction_, i), image = packet(image_, i);
      direction = packet(rest_, i) + onward * direction;
      image = packet(weight_, i) * direction;
      return direction * image;
    });
  }
  // Adds the sums around loops to the image. Returns their squares, which are what they add to the product.
  double add_loops() {
    double sum = 0;
    parallel_in_order(
        static_cast<std::int64_t>(parts_.size()), 1,
        [&](std::int64_t i, std::int64_t) { return parts_[i].add_sums(crossings_, direction_, image_); },
        [&](const std::vector<double>& of_blocks) { sum = std::accumulate(of_blocks.begin(), of_blocks.end(), sum); });
    return sum;
  }
  // Returns the squared norm of the rest.
  double advance(float step) {
    return sum_of_packets([&](std::int64_t i) -> Packet {
      auto correction = packet(correction_, i), rest = packet(rest_, i);
      correction += step * packet(direction_, i);
      rest -= step * packet(image_, i);
      return rest.square();
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

  CurlLimits limits_;
  float scale_ = 1;  // of the distances that are asked for
  std::span<const float> distances_;
  Crossings<K> crossings_;
  std::vector<std::int32_t> links_;    // those that loops lead along, ascending
  std::vector<LoopsOfPart<K>> parts_;  // one after the other
  ValuesOfAll<K> correction_, rest_, image_, direction_, stiffness_;
  ValuesOfAll<K> own_loops_, own_sums_;  // of the loops along each number alone: how many, and what they ask for
  ValuesOfAll<K> weight_;                // of each number: its stiffness and those loops
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
      thread_count() == 1 ? 1 : std::clamp(blocks / least_part, 1, std::min(thread_count(), most_parts));
  std::vector<std::int32_t> part_of_block(static_cast<std::size_t>(blocks));
  for (std::int32_t block = 0; block < blocks; ++block)
    part_of_block[block] = static_cast<std::int32_t>(std::int64_t{block} * count / blocks);
  const auto part_of = [&](std::int32_t link) { return part_of_block[link / links_in_block]; };
  // Calls body(bundle, part) for each part that one of its links belongs to.
  const auto for_each_part = [&](auto&& body) {
    std::array<std::size_t, most_parts> seen_in;
    seen_in.fill(bundles.size());
    for (std::size_t i = 0; i < bundles.size(); ++i) {
      if (bundles.has_one_step(i)) continue;
      for (const std::int32_t link : bundles.links_of(i))
        if (std::exchange(seen_in[part_of(link)], i) != i) body(i, part_of(link));
    }
  };
  std::size_t dealt = 0, whole = 0;
  for (std::size_t i = 0; i < bundles.size(); ++i) whole += bundles.has_one_step(i) ? 0 : 1;
  for_each_part([&](std::size_t, std::int32_t) { ++dealt; });
  if (static_cast<double>(dealt) > (1 + most_repeated) * static_cast<double>(whole)) {
    count = 1;
    std::ranges::fill(part_of_block, 0);
  }
  std::vector<LinkRange> ranges(static_cast<std::size_t>(count));
  for (std::int32_t block = 0; block < blocks; ++block)
    ranges[part_of_block[block]].end = std::min(all, (block + 1) * links_in_block);
  for (std::size_t part = 1; part < ranges.size(); ++part) ranges[part].begin = ranges[part - 1].end;
  for (const LinkRange& range : ranges) parts_.emplace_back(range);
  for_each_part([&](std::size_t bundle, std::int32_t part) { parts_[part].add(bundles, bundle); });
  for (std::size_t i = 0; i < bundles.size(); ++i)
    if (bundles.has_one_step(i)) bundles.add_one_step(crossings_, i, own_loops_, own_sums_);
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
