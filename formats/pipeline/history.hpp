#pragma once
// The history of a bundle: a JSON object {tool, version, options, ...counts} for each tool that wrote members of it, as
// history/NN-tool.json.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "common/run/run_context.hpp"
#include "formats/pipeline/bundle.hpp"

namespace hexpipe::pipeline {

bool is_history_entry(std::string_view member);

// The entry of the tool that runs.
nlohmann::ordered_json history_entry_of(const RunContext& context);

// Reads the current member, and stores its text in `text` if given. Throws DataError unless it is an object of at most
// 1 MiB and 64 levels. If it has a tool, its name must consist of a to z, 0 to 9 and '-'; if it has a version, this
// must be text; if it has options, these must be an object.
nlohmann::ordered_json read_history_entry(BundleReader& reader, std::string* text = nullptr);

// The name of the entry's tool; "stage" where it has no name.
std::string tool_of(const nlohmann::ordered_json& entry);

// The member's name for the entry with this number, from 1.
std::string history_member(int number, const nlohmann::ordered_json& entry);
// Writes U+FFFD in place of what is not UTF-8 in options: a file's name may have any bytes.
void write_history_entry(BundleWriter& writer, const std::string& member, const nlohmann::ordered_json& entry);
// Writes all entries, from the first.
void write_history(BundleWriter& writer, const std::vector<nlohmann::ordered_json>& history);

// Version and options of the last entry of a tool, without its counts. Null when it has no entry.
nlohmann::ordered_json settings_of(const std::string& tool, const std::vector<nlohmann::ordered_json>& history);

}  // namespace hexpipe::pipeline
