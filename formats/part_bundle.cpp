#include "formats/part_bundle.hpp"

#include <utility>

#include "common/run/error.hpp"
#include "formats/bundle.hpp"
#include "formats/input.hpp"
#include "formats/members.hpp"

namespace hexpipe {

PartHead read_part_bundle(const std::string& path, const std::function<bool(const MeshPart&)>& wanted) {
  Input input = Input::open(path);
  if (!looks_like_bundle(input)) throw DataError::at(path, "expected a bundle of a part, found another file");
  BundleReader reader(input);
  StageData data;
  bool judged = false;
  while (reader.next()) {
    const bool is_known = read_part_member(reader, data, nullptr);
    if (data.part && !std::exchange(judged, true) && !wanted(*data.part)) return {std::move(*data.part), std::nullopt};
    if (is_known) continue;
    const auto role = role_of_member(reader.name());
    if (role == Role::candidates) read_member(reader, data, nullptr, false);
    if (reader.name().starts_with("history/"))
      data.history.push_back(nlohmann::ordered_json::parse(reader.read_text(), nullptr, false));
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
  return {std::move(head), PartBundle{path, std::move(*data.part), std::move(*data.candidates),
                                      std::move(*data.candidate_keys), std::move(data.history)}};
}

nlohmann::ordered_json settings_of(const std::string& tool, const std::vector<nlohmann::ordered_json>& history) {
  for (auto entry = history.rbegin(); entry != history.rend(); ++entry)
    if (entry->is_object() && entry->value("tool", "") == tool)
      return {{"version", entry->value("version", "")},
              {"options", entry->value("options", nlohmann::ordered_json::object())}};
  return nullptr;
}

}  // namespace hexpipe
