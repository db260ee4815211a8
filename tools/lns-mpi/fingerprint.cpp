#include "tools/lns-mpi/fingerprint.hpp"

#include <array>

#include "common/run/random.hpp"

namespace hexpipe {
namespace {

// Modulo 2^64, in two halves so that no sum overflows.
std::uint64_t sum_over_ranks(Ranks& ranks, std::uint64_t value) {
  std::array<std::int64_t, 2> halves{static_cast<std::int64_t>(value >> 32),
                                     static_cast<std::int64_t>(value & 0xffffffffu)};
  ranks.sum(halves);
  return (static_cast<std::uint64_t>(halves[0]) << 32) + static_cast<std::uint64_t>(halves[1]);
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

void expect_agreement(Ranks& ranks, const OwnedRows& rows) {
  std::uint64_t sum = 0;
  for (std::size_t v = 0; v < rows.keys.size(); ++v)
    for (std::int64_t e = rows.offsets[v]; e < rows.offsets[v + 1]; ++e) {
      if (rows.neighbour_blocks[e] == rows.blocks[v]) continue;
      const std::uint64_t a = rows.keys[v], b = rows.neighbours[e];
      if (a < b)
        sum += mix(mix(a) + b);
      else
        sum -= mix(mix(b) + a);
    }
  const bool agree = sum_over_ranks(ranks, sum) == 0;
  ranks.together([&] {
    if (!agree) throw DataError("the parts disagree about the conflicts between them: they are not of one graph");
  });
}

}  // namespace hexpipe
