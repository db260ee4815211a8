#include "tools/lns-mpi/local_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "common/run/random.hpp"

namespace hexpipe::lns_mpi {
namespace {

// Modulo 2^64, in two halves so that no sum overflows.
std::uint64_t sum_over_ranks(Ranks& ranks, std::uint64_t value) {
  std::array<std::int64_t, 2> halves{static_cast<std::int64_t>(value >> 32),
                                     static_cast<std::int64_t>(value & 0xffffffffu)};
  ranks.sum(halves);
  return (static_cast<std::uint64_t>(halves[0]) << 32) + static_cast<std::uint64_t>(halves[1]);
}

// The conflicts of a block with the block beside it, as its rows have them.
struct Seen {
  std::int32_t block, beside;
  std::uint64_t sum;
};

DataError disagreement(std::int32_t a, std::int32_t b) {
  return DataError(fmt::format("parts {} and {} disagree about the conflicts between them: they are not of one graph",
                               std::min(a, b), std::max(a, b)));
}

}  // namespace

std::uint64_t fingerprint_of(Ranks& ranks, const OwnedRows& rows) {
  std::uint64_t sum = 0;
  for (std::size_t v = 0; v < rows.keys.size(); ++v) {
    std::uint64_t row = mix(static_cast<std::uint64_t>(rows.weights[v])) + static_cast<std::uint64_t>(rows.blocks[v]);
    for (std::int64_t e = rows.offsets[v]; e < rows.offsets[v + 1]; ++e) row += mix(rows.neighbours[e] + 1);
    sum += mix(mix(rows.keys[v]) + row);
  }
  return sum_over_ranks(ranks, sum);
}

void expect_agreement(Ranks& ranks, const BlockOwners& owners, const OwnedRows& rows) {
  // By block of the rank's own, and by another one: the conflicts between both, as the rows of the first have them.
  std::map<std::pair<std::int32_t, std::int32_t>, std::uint64_t> sums;
  auto sum = sums.end();  // of the last edge, because the next one mostly joins the same blocks
  for (std::size_t v = 0; v < rows.keys.size(); ++v)
    for (std::int64_t e = rows.offsets[v]; e < rows.offsets[v + 1]; ++e) {
      const std::pair both(rows.blocks[v], rows.neighbour_blocks[e]);
      if (both.first == both.second) continue;
      if (sum == sums.end() || sum->first != both) sum = sums.try_emplace(both, 0).first;
      const auto [low, high] = std::minmax(rows.keys[v], rows.neighbours[e]);
      sum->second += mix(mix(low) + high);
    }
  std::vector<Packer> packers(static_cast<std::size_t>(ranks.count()));
  for (const auto& [both, seen] : sums) packers[owners.rank_of(both.second)].put(Seen{both.first, both.second, seen});
  std::vector<Bytes> to;
  to.reserve(packers.size());
  for (Packer& packer : packers) to.push_back(packer.take());
  const std::vector<Bytes> seen_by_others = ranks.all_to_all(std::move(to));
  ranks.together([&] {
    for (const Bytes& bytes : seen_by_others)
      for (Unpacker unpacker(bytes); !unpacker.at_end();) {
        const auto seen = unpacker.get<Seen>();
        const auto own = sums.find({seen.beside, seen.block});
        if (own == sums.end() || own->second != seen.sum) throw disagreement(seen.block, seen.beside);
        sums.erase(own);
      }
    if (!sums.empty()) throw disagreement(sums.begin()->first.first, sums.begin()->first.second);
  });
}

}  // namespace hexpipe::lns_mpi
