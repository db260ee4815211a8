#pragma once
// FreeCAD's documents (.FCStd): zip archives with a tree of objects in XML, and the shape of each in BREP.

#include <string>
#include <string_view>

#include "tools/tessellate/cad_model.hpp"

namespace hexpipe::tessellate {

bool looks_like_freecad(std::string_view bytes);

// The shapes that the document shows, where its parts and links place them: not the features that a body or a Boolean
// operation consists of, which are hidden. If it shows no solid, those that no other object uses. Bodies have the
// labels of their objects, faces those of the FEM constraints on them, or else their own colours. Links to other
// documents are followed, from beside `path` (empty: from the current folder). Throws DataError for what is damaged or
// missing. `whole` gets all shapes that are shown.
CadModel read_freecad(const std::string& bytes, const std::string& name, const std::string& path, TopoDS_Shape& whole);

}  // namespace hexpipe::tessellate
