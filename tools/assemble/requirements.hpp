#pragma once
// Limits that --require sets; a result that misses one is not written.

#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::assemble {

struct Requirement {
  enum class Measure { hexes, cells, orthogonality, weight, determinant, flatness };
  Measure measure;
  double limit;  // of an angle in degrees: at most; of others: at least
};

// "hexes 0.3, orthogonality 70". Throws UsageError.
std::vector<Requirement> parse_requirements(std::string_view text);

// `mesh` has quality. Throws DataError if a requirement is missed; the message tells how many cells or faces miss it,
// and where the worst lies.
void check_requirements(const MixedMesh& mesh, const std::vector<Requirement>& requirements);

}  // namespace hexpipe::assemble
