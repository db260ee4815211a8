#include "tools/assemble/requirements.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "common/mesh/mesh_measures.hpp"
#include "common/run/error.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::assemble {
namespace {

using formats::trimmed;
using Measure = Requirement::Measure;

struct MeasureName {
  Measure measure;
  const char* name;
  double greatest;  // that can be asked for
};
constexpr std::array measure_names{MeasureName{Measure::hexes, "hexes", 1},
                                   MeasureName{Measure::cells, "cells", 1},
                                   MeasureName{Measure::orthogonality, "orthogonality", 180},
                                   MeasureName{Measure::weight, "weight", 0.5},
                                   MeasureName{Measure::determinant, "determinant", 1},
                                   MeasureName{Measure::flatness, "flatness", 1}};

Requirement parse_requirement(std::string_view text) {
  const auto expected = [&](const std::string& what) {
    return UsageError(fmt::format("--require: expected {}, found '{}'", what, text));
  };
  const std::size_t blank = text.find_first_of(" \t");
  const std::string_view name = text.substr(0, blank);
  const auto known = std::ranges::find(measure_names, name, &MeasureName::name);
  if (known == measure_names.end()) {
    std::vector<std::string_view> names;
    for (const MeasureName& measure : measure_names) names.push_back(measure.name);
    throw expected(fmt::format("{} and a number", fmt::join(names, ", ")));
  }
  const std::string_view number = blank == std::string_view::npos ? "" : trimmed(text.substr(blank));
  double limit = 0;
  const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), limit);
  if (error != std::errc{} || stop != number.data() + number.size() || !(limit >= 0 && limit <= known->greatest))
    throw expected(fmt::format("{} and a number from 0 to {}", name, known->greatest));
  return {known->measure, limit};
}

// Those that miss a requirement, and the worst of them.
struct Missed {
  std::int64_t count;
  const char* what;
  double worst;
  Vec3 place;
};

std::string text_of(const Requirement& requirement, const Missed& missed) {
  const char* const name = std::ranges::find(measure_names, requirement.measure, &MeasureName::measure)->name;
  return fmt::format("{} {}: {} {} miss it, the worst, {:.4g}, at ({:.6g}, {:.6g}, {:.6g})", name, requirement.limit,
                     missed.count, missed.what, missed.worst, missed.place.x, missed.place.y, missed.place.z);
}

template <class Block>
void count_poor(const MixedMesh& mesh, const Block& block, double limit, Missed& missed) {
  for (std::size_t i = 0; i < block.size(); ++i) {
    if (!(block.quality[i] < limit)) continue;
    if (++missed.count > 1 && !(block.quality[i] < missed.worst)) continue;
    missed.worst = block.quality[i];
    missed.place = {};
    for (const Vertex v : block.cells[i])
      missed.place += mesh.points[v] * (1.0 / static_cast<double>(block.cells[i].size()));
  }
}

Missed poor_cells_below(const MixedMesh& mesh, const Requirement& requirement) {
  const bool hexes_only = requirement.measure == Measure::hexes;
  Missed missed{0, hexes_only ? "hexes" : "cells", 1, {}};
  count_poor(mesh, mesh.hexes, requirement.limit, missed);
  if (hexes_only) return missed;
  count_poor(mesh, mesh.prisms, requirement.limit, missed);
  count_poor(mesh, mesh.pyramids, requirement.limit, missed);
  count_poor(mesh, mesh.tets, requirement.limit, missed);
  return missed;
}

// The requirements of finite volumes.
Missed poor_faces(const MixedMesh& mesh, const Requirement& requirement) {
  const auto missed = [](const MeasureCount& count, const char* what, double unit = 1) {
    return Missed{count.misses, what, count.worst / unit, count.place};
  };
  switch (requirement.measure) {
    case Measure::orthogonality:
      return missed(measure_mesh(mesh, {.angle = requirement.limit * degree}).angle, "faces", degree);
    case Measure::weight:
      return missed(measure_mesh(mesh, {.weight = requirement.limit}).weight, "faces");
    case Measure::determinant:
      return missed(measure_mesh(mesh, {.determinant = requirement.limit}).determinant, "cells");
    default:
      return missed(measure_mesh(mesh, {.flatness = requirement.limit}).flatness, "faces");
  }
}

}  // namespace

std::vector<Requirement> parse_requirements(std::string_view text) {
  std::vector<Requirement> result;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    result.push_back(parse_requirement(trimmed(text.substr(begin, end - begin))));
    begin = end + 1;
  }
  return result;
}

void check_requirements(const MixedMesh& mesh, const std::vector<Requirement>& requirements) {
  std::vector<std::string> texts;
  for (const Requirement& requirement : requirements) {
    const bool of_cells = requirement.measure == Measure::hexes || requirement.measure == Measure::cells;
    const Missed missed = of_cells ? poor_cells_below(mesh, requirement) : poor_faces(mesh, requirement);
    if (missed.count > 0) texts.push_back(text_of(requirement, missed));
  }
  if (!texts.empty()) throw DataError(fmt::format("--require {}", fmt::join(texts, "; ")));
}

}  // namespace hexpipe::assemble
