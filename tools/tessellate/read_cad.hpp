#pragma once
// Reads CAD files: STEP, IGES and BREP, recognized by content.

#include "formats/streams/input.hpp"
#include "tools/tessellate/cad_model.hpp"

namespace hexpipe::tessellate {

// Throws DataError if the file is empty, cut off, not CAD, or without bodies. Closed shells and faces that can be sewn
// to such become bodies, with a warning.
CadModel read_cad(formats::Input& input);

}  // namespace hexpipe::tessellate
