#include "common/mwis/target_weight.hpp"

#include <algorithm>
#include <cmath>

#include "common/run/error.hpp"

namespace hexpipe {

std::optional<std::int64_t> bound_in(const std::vector<nlohmann::ordered_json>& history) {
  std::optional<std::int64_t> lowest;
  for (const auto& entry : history) {
    if (!entry.is_object() || !entry.contains("tool")) continue;
    const auto& tool = entry["tool"];
    if (tool == "tetmesh" || tool == "findhex" || tool == "buildgraph") lowest.reset();
    const auto bound = entry.find("bound");
    if (tool != "certify" || bound == entry.end() || !bound->is_number_integer()) continue;
    lowest = std::min(lowest.value_or(bound->get<std::int64_t>()), bound->get<std::int64_t>());
  }
  return lowest;
}

double gap_to(std::int64_t bound, std::int64_t weight) {
  return bound > 0 ? static_cast<double>(bound - weight) / static_cast<double>(bound) : 0;
}

std::int64_t target_weight(double gap, std::optional<std::int64_t> bound) {
  if (!bound) throw DataError("--target-gap needs a bound: pipe the solution through certify first, or give --bound");
  return *bound - static_cast<std::int64_t>(std::floor(static_cast<long double>(*bound) * gap));
}

}  // namespace hexpipe
