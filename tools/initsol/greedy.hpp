#pragma once
// Greedy independent sets: takes vertices in an order of merit, each if no neighbour was taken (Verhetsel 2017, 3.3
// and 4.2).

#include <span>
#include <string_view>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::initsol {

enum class GreedyOrder {
  weight,
  weight_degree,  // weight / (degree + 1): the gain for each vertex that is decided
  quality,        // of the candidates, as indirect mesh generators do
};

// The merit of every vertex; only GreedyOrder::quality needs `quality`.
// The last `quads` vertices have less merit than all others.
std::vector<double> merits(const graph::ConflictGraph& graph, GreedyOrder order, std::span<const double> quality,
                           std::int32_t quads = 0);

// Takes the highest merit first, equal merits in the order of their vertices. The set is maximal.
graph::IndependentSet greedy(const graph::ConflictGraph& graph, std::span<const double> merits);

}  // namespace hexpipe::initsol
