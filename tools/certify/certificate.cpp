#include "tools/certify/certificate.hpp"

namespace hexpipe::certify {

void write_certificate(const graph::CliqueCover& cover, const mwis::bounds::CliqueDual& dual, formats::Output& output) {
  output.print("bound {}\n", dual.bound);
  for (std::int64_t c = 0; c < cover.size(); ++c) {
    if (dual.prices[c] == 0) continue;
    output.print("{}", dual.prices[c]);
    for (const std::int32_t v : cover.clique(c)) output.print(" {}", v + 1);
    output.print("\n");
  }
}

}  // namespace hexpipe::certify
