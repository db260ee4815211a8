#include "tools/hexpipe/run_stages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace hexpipe::front_door {
namespace {

// "hex", "hexes" and so on.
std::string counted(std::int64_t count, const std::string& kind) {
  if (count == 1) return fmt::format("1 {}", kind);
  return fmt::format("{} {}{}", count, kind, kind == "hex" ? "es" : "s");
}

}  // namespace

std::vector<std::string> summary_of(const nlohmann::ordered_json& assembled, const std::string& output,
                                    double seconds) {
  const auto& cells = assembled.at("cells");
  std::vector<std::string> counts;
  double share = 0, least = 1;
  std::string worst = "none";
  for (const auto& [kind, of_kind] : cells.items()) {
    const auto count = of_kind.at("count").get<std::int64_t>();
    if (count == 0) continue;
    counts.push_back(counted(count, kind));
    if (kind == "hex") share = of_kind.at("share_of_volume").get<double>();
    const double least_of_kind = of_kind.at("scaled_jacobian").at("least").get<double>();
    if (least_of_kind < least) {
      least = least_of_kind;
      worst = kind;
    }
  }
  const double distance = assembled.at("boundary").at("greatest_deviation").get<double>();
  return {
      fmt::format("{}; hexes fill {:.2f} % of the volume", fmt::join(counts, ", "), 100 * share),
      fmt::format("least scaled Jacobian {:.3f} (a {}); boundary within {:.3g} of the input's", least, worst, distance),
      fmt::format("{} after {:.1f} s", output, seconds)};
}

}  // namespace hexpipe::front_door
