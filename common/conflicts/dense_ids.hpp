#pragma once
// Candidates may use vertex and tet numbers that are far larger than their count.

#include <optional>

#include "common/mesh/candidates.hpp"

namespace hexpipe::conflicts {

// If a table by these numbers would take far more memory than the candidates: the candidates with vertices and tets
// renumbered from 0 in the same order. Otherwise nothing.
std::optional<Candidates> with_dense_ids(const Candidates& candidates);

}  // namespace hexpipe::conflicts
