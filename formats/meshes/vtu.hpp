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

// Reads ASCII, inline base64, and appended data (raw, base64), plain or compressed by zlib, and joins several pieces:
// of points with equal coordinates in several pieces, the first one takes the place of the others, told in `warnings`,
// if not null. The XML is parsed in place, which consumes the text. Throws FormatError or DataError.
MixedMesh read_vtu(std::string text, std::string_view file, std::vector<std::string>* warnings = nullptr);

// Writes inline base64 with 64-bit headers, in this machine's byte order.
void write_vtu(const MixedMesh& mesh, Output& output);

// Writes a piece of a mesh that is spread over several files, with the number of each point in the whole mesh.
void write_vtu_piece(const MixedMesh& mesh, const std::vector<std::int64_t>& point_number, Output& output);
// Writes PVTU, the file that names such pieces. Each piece has all arrays.
void write_pvtu(const std::vector<std::string>& pieces, Output& output);

}  // namespace hexpipe::formats
