#pragma once
// The proof of a bound as a text that others can check: a line `bound B`, then a line for each clique with a price, the
// price and the vertices counted from 1. Whoever adds up the prices, and what each vertex weighs beyond the prices of
// its cliques, gets the bound.

#include "common/graph/clique_cover.hpp"
#include "common/mwis/bounds/clique_dual.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::certify {

void write_certificate(const graph::CliqueCover& cover, const mwis::bounds::CliqueDual& dual, formats::Output& output);

}  // namespace hexpipe::certify
