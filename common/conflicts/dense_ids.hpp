#pragma once
// Vertex and tet numbers of candidates that are far more than the candidates could use.

#include <optional>

#include "common/mesh/candidates.hpp"

namespace hexpipe::conflicts {

// The candidates with vertices and tets renumbered from 0 in the same order, where a table by their numbers would take
// far more memory than the candidates themselves; nothing where it would not.
std::optional<Candidates> with_dense_ids(const Candidates& candidates);

}  // namespace hexpipe::conflicts
