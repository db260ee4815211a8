#pragma once
// Makes bodies of shells and faces, heals faulty bodies, and joins bodies that touch.

#include <TopoDS_Shape.hxx>
#include <string>

#include "tools/tessellate/cad_model.hpp"

namespace hexpipe::tessellate {

// For files without solids: closed shells become bodies, loose faces are sewn. Throws DataError if that gives nothing
// closed.
void make_bodies(const TopoDS_Shape& whole, const std::string& source, CadModel& model);

// Heals the bodies that OpenCASCADE finds faulty, with a warning.
void heal_bodies(CadModel& model);

// Lets bodies that touch share their common faces, edges and vertices. Throws DataError for bodies that overlap.
void join_bodies(const std::string& source, CadModel& model);

}  // namespace hexpipe::tessellate
