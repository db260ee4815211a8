#pragma once
// Ways across the bends of a surface count as longer than they are, so that rows of points lie closer there.

#include "tools/tetmesh/surface/crest_lines.hpp"
#include "tools/tetmesh/surface/cross_field.hpp"

namespace hexpipe::tetmesh::surface {

// Small fillets count as the edges that they round off (crest_lines.hpp). Across other bends, where the surface has
// `chord_heights`, rows lie so close that a straight line from one to the next leaves the surface by at most that, up
// to a limit. That holds as far as the bend goes on evenly along the field, because rows would end where it does not,
// and not where the surface bends both ways.
BendStretch bend_stretch(const FieldSurface& surface, const CrossField& field);

}  // namespace hexpipe::tetmesh::surface
