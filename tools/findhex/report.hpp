#pragma once
// The reports of findhex: warnings, lines for -v, and JSON for --stats.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/candidates/findhex.hpp"

namespace hexpipe::findhex {

std::vector<std::string> warnings_about(const candidates::MeshFindings& findings);

// The number of candidates of each kind, by the name of the kind.
nlohmann::ordered_json candidate_counts(const candidates::FindhexResult& result);

nlohmann::ordered_json statistics_of(const candidates::FindhexResult& result);

std::vector<std::string> summary_lines(const candidates::FindhexResult& result);

}  // namespace hexpipe::findhex
