#pragma once
// Candidates as text, one a line, for grep, sort and awk.
//
//   hexpipe-candidates 1 2 9 1
//   hex 0.8164965809277261 1 6 0 1 2 3 4 5 6 7 8 11 12 13 14 15 16
//   prism 0.7071067811865475 0.5 3 1 9 10 11 12 13 14 20 21 22 30
//
// The header has the word, the version, and the numbers of candidates, interior tets and boundary tets in all. A line
// has: kind (hex, prism, pyramid), quality, volume, number of interior tets, number of boundary tets; then the
// vertices (8, 6 or 5), the interior tets ascending, the boundary tets ascending. Vertices and tets count from 1 as in
// .mesh files, and so do candidates: the candidate of line n + 1 is vertex n of the .graph and number n in the .sol.
// Numbers are separated by single spaces when written, by blanks when read; numbers read back are the same doubles.

#include "common/mesh/candidates.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

// Throws FormatError.
Candidates read_cand(Input& input);
void write_cand(const Candidates& candidates, Output& output);

}  // namespace hexpipe::formats
