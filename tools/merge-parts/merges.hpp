#pragma once
// The ways to put bundles together. Each throws DataError when the bundles do not belong together.

#include <string>
#include <vector>

#include "formats/pipeline/bundle.hpp"
#include "tools/merge-parts/options.hpp"
#include "tools/merge-parts/part_reader.hpp"

namespace hexpipe::merge_parts {

// The first bundle tells the kind of all: pieces that assemble made, parts of a mesh, or shares of one list. Throws
// UsageError when the output cannot be written in the form that its name asks for, and DataError when the bundles do
// not belong together.
void merge_parts(const MergePartsOptions& options);

// Puts together the parts of a mesh, in any order: the mesh, and its candidates, graph and solution where they are
// there. Writes what a single run would have written, except the end of the archive. Every part has to be there once,
// of the same mesh and number of parts, and made with the same options.
void merge_parts_of_mesh(PartReaders& parts, pipeline::BundleWriter& out);

// Puts together what findhex or buildgraph made of one mesh or one list of candidates in shares (--part i/k). Writes
// what one run without --part would have written, except the end of the archive. The shares have to be 1/k to k/k in
// this order and to have the same members of earlier stages.
void merge_shares(PartReaders& parts, const std::vector<std::string>& paths, pipeline::BundleWriter& out);

// Whether the bundle is a piece that assemble made of a part of a mesh.
bool is_piece(const std::string& path);

// Puts such pieces together and writes the mesh to one file: a bundle, or another format by the file's ending. Where
// this is .pvtu, it writes that file and a .vtu of each piece in a folder of its name, and needs memory only for the
// largest piece and the facets between pieces. Every piece has to be there once, settled, of the same mesh, made with
// the same options, and the pieces have to fit together.
void merge_pieces(const std::vector<std::string>& paths, const std::string& output, bool compress);

}  // namespace hexpipe::merge_parts
