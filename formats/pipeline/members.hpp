#pragma once
// Reads and writes the members of a bundle that hold each role. formats/README.md lists them.

#include <optional>
#include <string_view>

#include "common/mesh/mesh_piece.hpp"
#include "common/run/stream_options.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/stage_data.hpp"

namespace hexpipe::pipeline {

// The role that a member belongs to by its name's folder; nothing for the history and for unknown members.
std::optional<Role> role_of_member(std::string_view name);

// Whether this member holds conflicts: most of a graph, which only searches and bounds need.
bool is_member_of_conflicts(std::string_view name);

// Reads the current member into `data` when it is one of its role's arrays, and also writes it to `copy` unless that is
// null. Reads a graph's clique cover only with `with_cover`. False: the member is not known (and still unread).
bool read_member(BundleReader& reader, StageData& data, BundleWriter* copy, bool with_cover);

// The same for the weights of the graph alone, as a graph without edges.
bool read_weights(BundleReader& reader, StageData& data, BundleWriter* copy);

// The same for the quads of the graph.
bool read_quads(BundleReader& reader, StageData& data, BundleWriter* copy);

// The same for kind and volume of candidates alone.
bool read_volumes(BundleReader& reader, StageData& data, BundleWriter* copy);

// The same for the lines along which rows of points end. Throws DataError at places that are no numbers.
bool read_dislocations(BundleReader& reader, StageData& data, BundleWriter* copy);

// Whether this member says that the mesh is a part of another, and which part.
bool is_part_title(std::string_view name);
// As read_member, for what a part of a mesh has beside mesh and candidates.
bool read_part_member(BundleReader& reader, StageData& data, BundleWriter* copy);

// The same for a piece of a result, and for what it has beside its mesh.
bool is_piece_title(std::string_view name);
bool read_piece_member(BundleReader& reader, std::optional<MeshPiece>& piece);

void write_members(BundleWriter& writer, const MeshPart& part);
void write_members(BundleWriter& writer, const CandidateKeys& keys);
void write_members(BundleWriter& writer, const TetMesh& mesh);
void write_members(BundleWriter& writer, const Candidates& candidates);
void write_members(BundleWriter& writer, const graph::ConflictGraph& graph);
void write_members(BundleWriter& writer, const graph::CliqueCover& cover);
void write_members(BundleWriter& writer, const graph::IndependentSet& solution);
// Only the weights of the graph.
void write_weights(BundleWriter& writer, const graph::ConflictGraph& graph);
void write_quads(BundleWriter& writer, const QuadsOfGraph& quads);
void write_gap_members(BundleWriter& writer, const SolutionGaps& gaps);
void write_dislocations(BundleWriter& writer, const DislocationSegments& segments);
void write_members(BundleWriter& writer, const MixedMesh& result);
void write_members(BundleWriter& writer, const MeshPiece& piece);

}  // namespace hexpipe::pipeline
