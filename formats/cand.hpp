#pragma once
// Candidates as text, one a line, for grep, sort and awk. See formats/README.md.

#include "common/mesh/candidates.hpp"
#include "formats/input.hpp"
#include "formats/output.hpp"

namespace hexpipe {

// Throws FormatError.
Candidates read_cand(Input& input);
void write_cand(const Candidates& candidates, Output& output);

}  // namespace hexpipe
