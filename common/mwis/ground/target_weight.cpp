#include "common/mwis/ground/target_weight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "common/run/error.hpp"

namespace hexpipe::mwis::ground {
namespace {

std::string_view tool_of(const nlohmann::ordered_json& entry) {
  const auto tool = entry.find("tool");
  return tool != entry.end() && tool->is_string() ? std::string_view(tool->get_ref<const std::string&>()) : "";
}

// Whether the stage made the graph (or the candidates behind it), or read it from a file instead of the bundle.
bool brings_another_graph(const nlohmann::ordered_json& entry) {
  const std::string_view tool = tool_of(entry);
  if (tool == "tetmesh" || tool == "findhex" || tool == "buildgraph") return true;
  const auto replaced = entry.find("replaced");
  return replaced != entry.end() && replaced->is_array() && std::ranges::any_of(*replaced, [](const auto& role) {
           return role == "mesh" || role == "candidates" || role == "graph";
         });
}

// Whether the stage is known to pass the graph on as it came. Stages of others may change weights or conflicts.
bool leaves_graph(const nlohmann::ordered_json& entry) {
  constexpr std::array tools{"initsol", "lns", "lns-mpi", "certify"};
  return entry.is_object() && !brings_another_graph(entry) && std::ranges::find(tools, tool_of(entry)) != tools.end();
}

// Of a search that came to the end of its proof.
std::optional<std::int64_t> optimum_of(const nlohmann::ordered_json& entry) {
  if (!entry.is_object() || (tool_of(entry) != "initsol" && tool_of(entry) != "lns")) return std::nullopt;
  const auto complete = entry.find("complete"), weight = entry.find("weight");
  if (complete == entry.end() || *complete != true || weight == entry.end() || !weight->is_number_integer())
    return std::nullopt;
  const auto proven = weight->get<std::int64_t>();
  return proven >= 0 ? std::optional(proven) : std::nullopt;
}

}  // namespace

std::optional<std::int64_t> bound_in(const std::vector<nlohmann::ordered_json>& history) {
  std::optional<std::int64_t> lowest;
  for (const auto& entry : history) {
    if (!entry.is_object()) continue;
    // This comes before the entry's own bound, because that is a bound for the graph that the stage was given.
    if (brings_another_graph(entry)) lowest.reset();
    const auto bound = entry.find("bound");
    if (tool_of(entry) != "certify" || bound == entry.end() || !bound->is_number_integer()) continue;
    const auto proven = bound->get<std::int64_t>();  // negative if it does not fit 64 bits
    if (proven >= 0) lowest = std::min(lowest.value_or(proven), proven);
  }
  return lowest;
}

std::optional<std::int64_t> optimum_in(const std::vector<nlohmann::ordered_json>& history) {
  std::optional<std::int64_t> optimum;
  for (const auto& entry : history) {
    if (!leaves_graph(entry)) optimum.reset();
    if (const auto proven = optimum_of(entry)) optimum = proven;
  }
  return optimum;
}

double gap_to(std::int64_t bound, std::int64_t weight) {
  return bound > 0 ? static_cast<double>(bound - weight) / static_cast<double>(bound) : 0;
}

std::int64_t target_weight(double gap, std::optional<std::int64_t> bound, std::int64_t constant) {
  if (!bound) throw DataError("--target-gap needs a bound: pipe the solution through certify first, or give --bound");
  return *bound - static_cast<std::int64_t>(std::floor(static_cast<long double>(*bound - constant) * gap));
}

}  // namespace hexpipe::mwis::ground
