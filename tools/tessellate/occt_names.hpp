#pragma once
// Names out of OpenCASCADE's documents and of STEP's entities.

#include <TCollection_ExtendedString.hxx>
#include <TDF_Label.hxx>
#include <TDocStd_Document.hxx>
#include <XSControl_WorkSession.hxx>
#include <string>

#include "tools/tessellate/cad_model.hpp"

namespace hexpipe::tessellate {

// Without what says that there is no name.
std::string cad_name(const std::string& text);
std::string name_of_label(const TDF_Label& label);

// Those that STEP's entities have: faces, edges and solids.
void add_entity_names(const Handle(XSControl_WorkSession) & session, ShapeNames& names);

// Of the document: its labels' names of sub-shapes, then layers, then colours that faces have for themselves.
void add_document_names(const Handle(TDocStd_Document) & document, ShapeNames& names);

// The bodies of all instances, each with its own name or that of its part.
void add_bodies(const Handle(TDocStd_Document) & document, CadModel& model);

}  // namespace hexpipe::tessellate
