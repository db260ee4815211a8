#pragma once
// What was done to the members of a bundle: a JSON object {tool, version, options, ...counts} for each tool that wrote
// some, as history/NN-tool.json.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "common/run/run_context.hpp"
#include "formats/pipeline/bundle.hpp"

namespace hexpipe::pipeline {

bool is_history_entry(std::string_view member);

// Of the tool that runs.
nlohmann::ordered_json history_entry_of(const RunContext& context);

// The current member, and its text where that is wanted. Throws DataError unless it is an object of at most 1 MiB and
// 64 levels of which, if there, the tool is named by a to z, 0 to 9 and '-', the version text and the options an
// object.
nlohmann::ordered_json read_history_entry(BundleReader& reader, std::string* text = nullptr);

// "stage" where the entry does not say.
std::string tool_of(const nlohmann::ordered_json& entry);

// Of the entry that comes so many-th, from 1.
std::string history_member(int number, const nlohmann::ordered_json& entry);
// What is no UTF-8 in options, as a name of a file may be, is written as U+FFFD.
void write_history_entry(BundleWriter& writer, const std::string& member, const nlohmann::ordered_json& entry);
// All of them, from the first.
void write_history(BundleWriter& writer, const std::vector<nlohmann::ordered_json>& history);

// The last entry of a tool, without its counts: version and options. Null where there is none.
nlohmann::ordered_json settings_of(const std::string& tool, const std::vector<nlohmann::ordered_json>& history);

}  // namespace hexpipe::pipeline
