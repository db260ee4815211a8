#pragma once
// Surfaces that are no manifolds: bodies that touch in faces, edges or vertices, walls inside. They consist of sheets,
// which meet at edges of more than two triangles.

#include <cstddef>
#include <string>
#include <vector>

#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

// Whether an edge has more than two triangles, or all edges have two and a vertex has several fans of them.
bool meets_in_sheets(const formats::SurfaceSoup& soup);

struct SheetReport {
  std::size_t interface_triangles = 0;  // that two bodies had, and are one now
  std::size_t fins = 0;                 // triangles with the same on both sides, which went

  // What there is to tell, in sentences.
  std::vector<std::string> sentences() const;
};

// Finds the sides of a soup that says nothing of them, by walking around each edge: a room between triangles is a
// region where one of them has its back to it (ShellRule::oriented), or wherever it is closed (regions). Throws
// DataError for the rule holes, for repeated triangles that are turned alike, for those that show their backs to the
// outside, and where nothing is enclosed.
SheetReport find_sides(formats::SurfaceSoup& soup, ShellRule rule);

// Of a soup that has sides: bodies that have the same triangles where they touch share them from then on.
SheetReport join_bodies(formats::SurfaceSoup& soup);

// The sheets of a soup with sides, in place of shells. Triangles between two regions have the lower number behind them.
Surface find_sheets(formats::SurfaceSoup soup);

}  // namespace hexpipe::tetmesh::solid
