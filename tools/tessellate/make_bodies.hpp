#pragma once
// Bodies out of what is none yet, or is faulty: shells and faces, shapes that do not hold together, bodies that touch.

#include <TopoDS_Shape.hxx>
#include <string>

#include "tools/tessellate/cad_model.hpp"

namespace hexpipe::tessellate {

// Where a file has no solids: closed shells become bodies, loose faces are sewn. Throws DataError where nothing closed
// comes of it.
void make_bodies(const TopoDS_Shape& whole, const std::string& source, CadModel& model);

// Heals the bodies that OpenCASCADE finds faulty, with a warning.
void heal_bodies(CadModel& model);

// Bodies that touch share the faces, edges and vertices where they do. Throws DataError for bodies that overlap.
void join_bodies(const std::string& source, CadModel& model);

}  // namespace hexpipe::tessellate
