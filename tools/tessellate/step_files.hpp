#pragma once
// What has to be right in a STEP file, and in the others in which an assembly keeps its parts.

#include <IFSelect_ReturnStatus.hxx>
#include <XSControl_WorkSession.hxx>
#include <string>
#include <string_view>
#include <vector>

namespace hexpipe::tessellate {

// Throws DataError if the bytes do not end with the last word of a STEP file. Blanks and comments behind it do not
// count.
void check_end_of_step(std::string_view bytes, const std::string& name);

// Throws DataError if OpenCASCADE could not read a STEP file.
void check_was_read(IFSelect_ReturnStatus status, const std::string& name);

// What a message says of entities of which OpenCASCADE cannot read all; empty if it could. It takes a default for what
// it cannot read, 0 for a coordinate.
std::string faulty_entities(const Handle(XSControl_WorkSession) & session);

// What a message says of solids that were transferred, but of which OpenCASCADE made none; empty if there are none.
std::string lost_solids(const Handle(XSControl_WorkSession) & session);

// Checks all files to which a STEP file that was read refers for parts, and those to which they refer: OpenCASCADE
// leaves out without a word what it cannot find, and does not end where files refer to each other in a circle. What is
// not named as a STEP file holds no parts. Adds a warning for each that has faulty entities. Throws DataError for one
// that is missing or cannot be read, and for a circle. `name` is that of the first file in messages; others are sought
// beside the file that refers to them.
void check_referenced_files(const Handle(XSControl_WorkSession) & session, const std::string& name,
                            std::vector<std::string>& warnings);

}  // namespace hexpipe::tessellate
