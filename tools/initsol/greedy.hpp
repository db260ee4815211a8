#pragma once
// Greedy independent sets: vertices in some order of merit, each taken when no neighbour is (Verhetsel 2017, 3.3
// and 4.2).

#include <span>
#include <string_view>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::initsol {

enum class GreedyOrder {
  weight,
  weight_degree,  // weight / (degree + 1), what a vertex brings for each vertex that it decides
  quality,        // of the candidates; what indirect mesh generators do
};

// The merit of every vertex; `quality` is looked at for that order only.
std::vector<double> merits(const graph::ConflictGraph& graph, GreedyOrder order, std::span<const double> quality);

// The highest merit first, equal ones in the order of their numbers. The set is maximal.
graph::IndependentSet greedy(const graph::ConflictGraph& graph, std::span<const double> merits);

}  // namespace hexpipe::initsol
