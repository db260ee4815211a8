#pragma once
// The result, in three lines for people.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hexpipe::front_door {

// `assembled` is what assemble wrote by --stats; `output` names the file; `seconds` are by the clock.
std::vector<std::string> summary_of(const nlohmann::ordered_json& assembled, const std::string& output, double seconds);

}  // namespace hexpipe::front_door
