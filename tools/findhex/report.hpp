#pragma once
// The reports of findhex: warnings, lines for -v, and JSON for --stats.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/candidates/findhex.hpp"

namespace hexpipe {

std::vector<std::string> warnings_about(const MeshFindings& findings);

// The number of candidates of each kind, by the name of the kind.
nlohmann::ordered_json candidate_counts(const FindhexResult& result);

nlohmann::ordered_json statistics_of(const FindhexResult& result);

std::vector<std::string> summary_lines(const FindhexResult& result);

}  // namespace hexpipe
