#pragma once
// FreeCAD's documents (.FCStd): what they show becomes bodies.

#include <string>
#include <string_view>

#include "tools/tessellate/cad_model.hpp"

namespace hexpipe::tessellate {

bool looks_like_freecad(std::string_view bytes);

// The shapes that the document shows, where its parts and links place them. If it shows no solid and bodies are needed,
// hidden solids are taken, but for those of which others are made. Bodies have the labels of their objects, faces those
// of the FEM constraints on them, or else their own colours. Links to other documents are followed, from beside `path`
// (empty: from the current folder). Throws DataError for what is damaged or missing. `whole` gets all shapes.
CadModel read_freecad(const std::string& bytes, const std::string& name, const std::string& path, bool needs_bodies,
                      TopoDS_Shape& whole);

}  // namespace hexpipe::tessellate
