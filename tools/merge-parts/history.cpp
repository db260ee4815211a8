#include "tools/merge-parts/history.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "common/run/error.hpp"
#include "formats/pipeline/history.hpp"

namespace hexpipe::merge_parts {
namespace {

// Counts of parts that add up to those of the whole: a number, or an object of numbers.
void add_counts(nlohmann::ordered_json& sum, const nlohmann::ordered_json& counts) {
  if (sum.is_number_integer() && counts.is_number_integer())
    sum = sum.get<std::int64_t>() + counts.get<std::int64_t>();
  else if (sum.is_object() && counts.is_object())
    for (auto& [name, value] : sum.items())
      if (counts.contains(name)) add_counts(value, counts[name]);
}

// Counts in a tool's entry that are of its part alone.
const std::map<std::string, std::vector<const char*>> counts_of_tools{{"findhex", {"candidates"}},
                                                                      {"buildgraph", {"vertices", "edges"}}};

std::vector<const char*> counts_of(const std::string& tool) {
  const auto found = counts_of_tools.find(tool);
  return found == counts_of_tools.end() ? std::vector<const char*>() : found->second;
}

// The role that a tool makes; for an unknown tool, the role that was made last.
Role role_of(const std::string& tool, Role latest) {
  static const std::map<std::string, Role> made{{"tetmesh", Role::mesh},     {"findhex", Role::candidates},
                                                {"buildgraph", Role::graph}, {"initsol", Role::solution},
                                                {"lns", Role::solution},     {"lns-mpi", Role::solution}};
  const auto found = made.find(tool);
  return found == made.end() ? latest : found->second;
}

void merge_into(nlohmann::ordered_json& entry, const nlohmann::ordered_json& other, PartReader& part) {
  nlohmann::ordered_json same = entry, same_other = other;
  for (const char* name : counts_of(pipeline::tool_of(entry))) {
    same.erase(name);
    same_other.erase(name);
  }
  if (same != same_other)
    throw DataError::at(part.bundle().where(),
                        "expected a run with the same version and options as in the first part, found another");
  for (const char* name : counts_of(pipeline::tool_of(entry)))
    if (entry.contains(name) && other.contains(name)) add_counts(entry[name], other[name]);
}

}  // namespace

void MergedHistory::take(PartReaders& parts) {
  nlohmann::ordered_json entry = pipeline::read_history_entry(parts.front().bundle());
  for (std::size_t p = 1; p < parts.size(); ++p)
    merge_into(entry, pipeline::read_history_entry(parts[p].bundle()), parts[p]);
  if (pipeline::tool_of(entry) == "mesh-part") return;
  latest_ = std::max(latest_, role_of(pipeline::tool_of(entry), latest_));
  entries_.push_back({std::move(entry), latest_});
}

std::vector<std::string> MergedHistory::take_shares(PartReaders& parts) {
  std::vector<std::string> shares;
  nlohmann::ordered_json entry;
  for (PartReader& part : parts) {
    nlohmann::ordered_json other = pipeline::read_history_entry(part.bundle());
    other.emplace("options", nlohmann::ordered_json::object());
    nlohmann::ordered_json& options = other["options"];
    const auto share = options.find("part");
    shares.push_back(share != options.end() && share->is_string() ? share->get<std::string>() : "");
    options["part"] = "1/1";
    if (entry.is_null())
      entry = std::move(other);
    else
      merge_into(entry, other, part);
  }
  latest_ = std::max(latest_, role_of(pipeline::tool_of(entry), latest_));
  entries_.push_back({std::move(entry), latest_});
  return shares;
}

void MergedHistory::write(Entry& entry, const std::string& name, const MergedCounts& counts,
                          pipeline::BundleWriter& out) {
  const bool of_graph = pipeline::tool_of(entry.json) == "buildgraph";
  if (of_graph && counts.vertices) entry.json["vertices"] = *counts.vertices;
  if (of_graph && counts.edges) entry.json["edges"] = *counts.edges;
  pipeline::write_history_entry(out, name, entry.json);
}

void MergedHistory::write_before(std::optional<Role> role, const MergedCounts& counts, pipeline::BundleWriter& out) {
  std::size_t done = 0;
  for (; done < entries_.size() && (!role || entries_[done].made < *role); ++done)
    write(entries_[done], pipeline::history_member(++written_, entries_[done].json), counts, out);
  entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(done));
}

void MergedHistory::write_last(const std::string& name, const MergedCounts& counts, pipeline::BundleWriter& out) {
  for (Entry& entry : entries_) write(entry, name, counts, out);
}

}  // namespace hexpipe::merge_parts
