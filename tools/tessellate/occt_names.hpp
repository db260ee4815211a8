#pragma once
// Names from OpenCASCADE's documents and STEP's entities.

#include <TCollection_ExtendedString.hxx>
#include <TDF_Label.hxx>
#include <TDocStd_Document.hxx>
#include <XSControl_WorkSession.hxx>
#include <string>

#include "tools/tessellate/cad_model.hpp"

namespace hexpipe::tessellate {

// The name; empty if the text only says that there is no name.
std::string cad_name(const std::string& text);
std::string name_of_label(const TDF_Label& label);

// Adds the names of STEP's entities: faces, edges and solids.
void add_entity_names(const Handle(XSControl_WorkSession) & session, ShapeNames& names);

// Adds the names in the document: its labels' names of sub-shapes, then layers, then colours that faces have of their
// own.
void add_document_names(const Handle(TDocStd_Document) & document, ShapeNames& names);

// Adds the bodies of all instances, each with its own name or that of its part.
void add_bodies(const Handle(TDocStd_Document) & document, CadModel& model);

}  // namespace hexpipe::tessellate
