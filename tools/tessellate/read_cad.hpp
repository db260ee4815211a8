#pragma once
// CAD files: STEP, IGES and BREP, told by their content.

#include "formats/streams/input.hpp"
#include "tools/tessellate/cad_model.hpp"

namespace hexpipe::tessellate {

// Throws DataError where the file is empty, cut off or no CAD, and where it has no bodies. Closed shells and faces that
// can be sewn to such become bodies, with a warning.
CadModel read_cad(formats::Input& input);

}  // namespace hexpipe::tessellate
