#pragma once
// Which members of a bundle hold which role, and how they are read and written. formats/README.md lists them.

#include <optional>
#include <string_view>

#include "common/mesh/mesh_piece.hpp"
#include "common/run/stream_options.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/stage.hpp"

namespace hexpipe::pipeline {

// The role that a member belongs to by its name's folder; nothing for history and for members that we do not know.
std::optional<Role> role_of_member(std::string_view name);

// Takes the current member into `data` when it is one of its role's arrays, and also writes it to `copy` unless that is
// null. A graph's clique cover is taken only where `with_cover` says so. False: the member is not known (and still
// unread).
bool read_member(BundleReader& reader, StageData& data, BundleWriter* copy, bool with_cover);

// The same for the weights of the graph alone, which is then one without edges.
bool read_weights(BundleReader& reader, StageData& data, BundleWriter* copy);

// Whether it says that what follows is a part of a mesh, and which.
bool is_part_title(std::string_view name);
// The same for what a part of a mesh has beside mesh and candidates.
bool read_part_member(BundleReader& reader, StageData& data, BundleWriter* copy);

bool is_piece_title(std::string_view name);
// The same for what a piece of a result has beside it.
bool read_piece_member(BundleReader& reader, std::optional<MeshPiece>& piece);

void write_members(BundleWriter& writer, const MeshPart& part);
void write_members(BundleWriter& writer, const CandidateKeys& keys);
void write_members(BundleWriter& writer, const TetMesh& mesh);
void write_members(BundleWriter& writer, const Candidates& candidates);
void write_members(BundleWriter& writer, const graph::ConflictGraph& graph);
void write_members(BundleWriter& writer, const graph::CliqueCover& cover);
void write_members(BundleWriter& writer, const graph::IndependentSet& solution);
// StageData::gaps.
void write_gap_members(BundleWriter& writer, const std::vector<std::int64_t>& gaps);
void write_members(BundleWriter& writer, const MixedMesh& result);
void write_members(BundleWriter& writer, const MeshPiece& piece);

}  // namespace hexpipe::pipeline
