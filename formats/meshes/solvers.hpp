#pragma once
// What solvers take, for --solver.

#include <string>
#include <string_view>

#include "common/run/stream_options.hpp"
#include "formats/meshes/mesh_writing.hpp"

namespace hexpipe::formats {

// How a mesh is written for what the command line asks. Throws UsageError where the solver does not read the format.
MeshWriting mesh_writing(const MeshOptions& options, std::string_view format);

// One line: what is written for the solver; empty where none is named.
std::string solver_summary(const MeshOptions& options, const MeshWriting& writing);

}  // namespace hexpipe::formats
