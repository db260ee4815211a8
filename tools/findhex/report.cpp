#include "tools/findhex/report.hpp"

#include <fmt/format.h>

#include <utility>

namespace hexpipe::findhex {
namespace {

constexpr std::pair<candidates::TetVerdict, const char*> rejections[] = {
    {candidates::TetVerdict::no_interior, "rule 5, no tets between the facets"},
    {candidates::TetVerdict::tet_count, "rule 6, too few or too many tets"},
    {candidates::TetVerdict::boundary_tets, "too many boundary tets"},
    {candidates::TetVerdict::crosses_mesh, "rules 6 and 7, a boundary, region or unusable tet within"},
    {candidates::TetVerdict::half_on_surface, "rule 7, a quad half on a surface"},
    {candidates::TetVerdict::inner_vertex, "an inner vertex"},
    {candidates::TetVerdict::flat_corner, "rule 9, a flat corner left at the surface"},
    {candidates::TetVerdict::sharp_edge, "rule 10, a quad over a sharp edge of the surface"},
};

std::int64_t count_of(const candidates::CellCounts& counts, candidates::TetVerdict verdict) {
  return counts.by_verdict[static_cast<std::size_t>(verdict)];
}

std::string plural(CellKind kind) {
  return std::string(name_of(kind)) + (kind == CellKind::hex ? "es" : "s");
}

}  // namespace

std::vector<std::string> warnings_about(const candidates::MeshFindings& findings) {
  std::vector<std::string> warnings;
  const TetOrientation& orientation = findings.orientation;
  if (const auto turned = turned_tets_warning(orientation)) warnings.push_back(*turned);
  if (orientation.inverted + orientation.flat > 0)
    warnings.push_back(fmt::format("{} inverted and {} flat of {} tets: no candidate uses them", orientation.inverted,
                                   orientation.flat, orientation.signs.size()));
  return warnings;
}

nlohmann::ordered_json candidate_counts(const candidates::FindhexResult& result) {
  auto json = nlohmann::ordered_json::object();
  for (const candidates::KindCounts& kind : result.counts) json[plural(kind.kind)] = kind.counts.accepted();
  return json;
}

nlohmann::ordered_json statistics_of(const candidates::FindhexResult& result) {
  auto json = nlohmann::ordered_json::object();
  json["tets"] = result.findings.orientation.signs.size();
  json["turned_tets"] = result.findings.orientation.turned;
  json["inverted_tets"] = result.findings.orientation.inverted;
  json["flat_tets"] = result.findings.orientation.flat;
  json["derived_triangles"] = result.findings.derived_triangles;
  json["triangulated_quads"] = result.triangulated_quads;
  json["candidates"] = result.candidates.size();
  for (const candidates::KindCounts& kind : result.counts) {
    nlohmann::ordered_json rejected{{"rule 4, not valid", kind.counts.invalid}};
    for (const auto& [verdict, why] : rejections) rejected[why] = count_of(kind.counts, verdict);
    json[plural(kind.kind)] = {
        {"candidates", kind.counts.accepted()}, {"complete", kind.counts.complete}, {"rejected", std::move(rejected)}};
  }
  return json;
}

std::vector<std::string> summary_lines(const candidates::FindhexResult& result) {
  std::vector<std::string> lines{fmt::format("{} tets, {} triangulated quads", result.findings.orientation.signs.size(),
                                             result.triangulated_quads)};
  if (result.findings.derived_triangles > 0)
    lines.push_back(fmt::format("{} surface triangles derived, with tag 0", result.findings.derived_triangles));
  for (const candidates::KindCounts& kind : result.counts) {
    lines.push_back(fmt::format("{} {} of {} with all facets and good corners", kind.counts.accepted(),
                                plural(kind.kind), kind.counts.complete));
    if (kind.counts.invalid > 0) lines.push_back(fmt::format("  {} rejected: rule 4, not valid", kind.counts.invalid));
    for (const auto& [verdict, why] : rejections)
      if (count_of(kind.counts, verdict) > 0)
        lines.push_back(fmt::format("  {} rejected: {}", count_of(kind.counts, verdict), why));
  }
  return lines;
}

}  // namespace hexpipe::findhex
