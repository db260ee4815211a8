#pragma once
// The elements that solvers accept, for --solver.

#include <string>
#include <string_view>

#include "common/run/stream_options.hpp"
#include "formats/meshes/mesh_writing.hpp"

namespace hexpipe::formats {

// How to write a mesh as the command line asks. Throws UsageError if the solver does not read the format.
MeshWriting mesh_writing(const MeshOptions& options, std::string_view format);

// Throws UsageError if a mesh of second order cannot be written so. `full`: with nodes in quads and hexes.
void expect_second_order(const MeshOptions& options, std::string_view format, bool full);

// One line that says what is written for the solver; empty if none is named.
std::string solver_summary(const MeshOptions& options, const MeshWriting& writing);

}  // namespace hexpipe::formats
