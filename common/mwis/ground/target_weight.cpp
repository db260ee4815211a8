#include "common/mwis/ground/target_weight.hpp"

#include <algorithm>
#include <cmath>

#include "common/run/error.hpp"

namespace hexpipe::mwis::ground {
namespace {

// Whether the stage made the graph (or the candidates behind it), or read it from a file instead of the bundle.
bool brings_another_graph(const nlohmann::ordered_json& entry) {
  const auto tool = entry.find("tool");
  if (tool != entry.end() && (*tool == "tetmesh" || *tool == "findhex" || *tool == "buildgraph")) return true;
  const auto replaced = entry.find("replaced");
  return replaced != entry.end() && replaced->is_array() && std::ranges::any_of(*replaced, [](const auto& role) {
           return role == "mesh" || role == "candidates" || role == "graph";
         });
}

}  // namespace

std::optional<std::int64_t> bound_in(const std::vector<nlohmann::ordered_json>& history) {
  std::optional<std::int64_t> lowest;
  for (const auto& entry : history) {
    if (!entry.is_object()) continue;
    // This comes before the entry's own bound, because that is a bound for the graph that the stage was given.
    if (brings_another_graph(entry)) lowest.reset();
    const auto tool = entry.find("tool"), bound = entry.find("bound");
    if (tool == entry.end() || *tool != "certify" || bound == entry.end() || !bound->is_number_integer()) continue;
    const auto proven = bound->get<std::int64_t>();  // negative if it does not fit 64 bits
    if (proven >= 0) lowest = std::min(lowest.value_or(proven), proven);
  }
  return lowest;
}

double gap_to(std::int64_t bound, std::int64_t weight) {
  return bound > 0 ? static_cast<double>(bound - weight) / static_cast<double>(bound) : 0;
}

std::int64_t target_weight(double gap, std::optional<std::int64_t> bound, std::int64_t constant) {
  if (!bound) throw DataError("--target-gap needs a bound: pipe the solution through certify first, or give --bound");
  return *bound - static_cast<std::int64_t>(std::floor(static_cast<long double>(*bound - constant) * gap));
}

}  // namespace hexpipe::mwis::ground
