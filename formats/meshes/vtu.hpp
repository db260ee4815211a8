#pragma once
// VTU, VTK's XML format for unstructured grids. See formats/README.md.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::formats {

bool looks_like_vtu(std::string_view text);

// ASCII, inline base64, and appended data (raw, base64), plain or compressed by zlib; several pieces are joined. The
// XML is parsed in place, so the text is consumed. Throws FormatError or DataError.
MixedMesh read_vtu(std::string text, std::string_view file);

// Appended raw data with 64-bit headers, in this machine's byte order.
void write_vtu(const MixedMesh& mesh, Output& output);

// A piece of a mesh that lies in several files, with the number in the whole of each point.
void write_vtu_piece(const MixedMesh& mesh, const std::vector<std::int64_t>& point_number, Output& output);
// PVTU: the file that names these pieces, which have all their arrays.
void write_pvtu(const std::vector<std::string>& pieces, Output& output);

}  // namespace hexpipe::formats
