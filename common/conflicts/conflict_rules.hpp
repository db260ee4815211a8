#pragma once
// When two candidates cannot both be chosen: the table of docs/definitions.md 2.

#include <cstddef>

#include "common/mesh/candidates.hpp"

namespace hexpipe::conflicts {

// Decides for one pair, from nothing but its tets and vertices.
bool in_conflict(const Candidates& candidates, std::size_t i, std::size_t j);

}  // namespace hexpipe::conflicts
