#include "formats/pipeline/part_bundle.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "common/run/error.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/members.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe::pipeline {

PartHead read_part_bundle(const std::string& path, const std::function<bool(const MeshPart&)>& wanted) {
  formats::Input input = formats::Input::open(path);
  if (!looks_like_bundle(input)) throw DataError::at(path, "expected a bundle of a part, found another file");
  BundleReader reader(input);
  StageData data;
  bool judged = false;
  while (reader.next()) {
    const bool is_known = read_part_member(reader, data, nullptr);
    if (data.part && !std::exchange(judged, true) && !wanted(*data.part)) return {std::move(*data.part), std::nullopt};
    if (is_known) continue;
    const auto role = role_of_member(reader.name());
    if (role == Role::candidates || role == Role::solution) read_member(reader, data, nullptr, false);
    if (is_history_entry(reader.name())) data.history.push_back(read_history_entry(reader));
  }
  if (!data.part) throw DataError::at(path, "expected a part of a mesh, as mesh-part makes them, found a whole");
  if (!data.candidates || !data.candidate_keys)
    throw DataError::at(path, "expected candidates with their keys, as findhex makes them of a part, found none");
  validate(*data.part, path.c_str());
  validate(*data.candidates, path.c_str());
  validate(*data.candidate_keys, data.candidates->size(), path.c_str());
  validate_against(*data.part, *data.candidates, path.c_str());
  MeshPart head;
  head.part = data.part->part;
  head.parts = data.part->parts;
  head.whole = data.part->whole;
  return {std::move(head),
          PartBundle{path, std::move(*data.part), std::move(*data.candidates), std::move(*data.candidate_keys),
                     std::move(data.solution), std::move(data.history)}};
}

namespace {

void check_head(const MeshPart& other, const MeshPart& part, const std::string& name, const std::string& source) {
  if (other.whole != part.whole)
    throw DataError::at(name, "expected a part of the same mesh as {}, found one of another", source);
  if (other.parts != part.parts)
    throw DataError::at(name, "expected one of {} parts as {}, found {}", part.parts, source, title_of(other));
}

}  // namespace

void for_each_neighbour(const MeshPart& part, const std::vector<std::string>& paths, const std::string& source,
                        const std::function<void(const PartBundle&)>& visit) {
  std::map<std::int32_t, std::string> found;
  const auto is_neighbour = [&](const MeshPart& other) {
    return std::binary_search(part.neighbours.begin(), part.neighbours.end(), other.part);
  };
  for (const std::string& path : paths) {
    const PartHead head = read_part_bundle(path, is_neighbour);
    check_head(head.part, part, path, source);
    const auto [twin, is_first] = found.emplace(head.part.part, path);
    if (!is_first)
      throw DataError::at(path, "expected each part once, found {} as in {}", title_of(head.part), twin->second);
    if (head.bundle) visit(*head.bundle);
  }
  for (const std::int32_t neighbour : part.neighbours)
    if (!found.contains(neighbour))
      throw DataError::at(source, "expected the neighbours of {} with --neighbours, found no part {}", title_of(part),
                          neighbour);
}

PieceBundle read_piece_bundle(const std::string& path, bool with_mesh) {
  formats::Input input = formats::Input::open(path);
  if (!looks_like_bundle(input)) throw DataError::at(path, "expected a bundle of a piece, found another file");
  BundleReader reader(input);
  StageData data;
  std::optional<MeshPiece> piece;
  while (reader.next()) {
    if (read_piece_member(reader, piece)) continue;
    if (with_mesh && role_of_member(reader.name()) == Role::result) read_member(reader, data, nullptr, false);
    if (with_mesh && is_history_entry(reader.name())) data.history.push_back(read_history_entry(reader));
    if (with_mesh && reader.name() == formats::names_member)
      data.names = formats::parse_group_names(reader.read_text(), reader.where());
  }
  if (!piece) throw DataError::at(path, "expected a piece of a mesh, as assemble makes them of parts, found none");
  validate(*piece, path.c_str());
  MixedMesh mesh = std::move(data.result).value_or(MixedMesh());
  if (with_mesh) {
    validate(mesh, path.c_str());
    validate_against(*piece, mesh, path.c_str());
  }
  return {path, std::move(*piece), std::move(mesh), std::move(data.history), std::move(data.names)};
}

}  // namespace hexpipe::pipeline
