#pragma once
// Bodies that touch share their common faces, edges and vertices; of bodies that overlap one is cut.

#include <cstddef>
#include <string>

namespace hexpipe::tessellate {

struct CadModel;

// Whose what two bodies have in common is.
enum class Overlaps {
  refuse,  // an error
  first,   // that of the first one in the file
  last,
  small,  // that of the one with the smaller volume, of equal ones that of the first
};

// Lets bodies that touch share their common faces, edges and vertices, and puts sheets into the bodies that they lie
// in, as internal faces; a sheet that lies in none is left out. If there is a rule, what a body has in common with
// others may be cut off it: a body may end in pieces, which become bodies of its name, or as none. Warnings tell all
// that. Returns how many pairs overlapped. Throws DataError for bodies that overlap if there is no rule.
std::size_t join_bodies(const std::string& source, Overlaps rule, CadModel& model);

}  // namespace hexpipe::tessellate
