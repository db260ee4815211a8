#include "tools/assemble/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/mesh/quality.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe::assemble {
namespace {

template <class Visit>
void for_each_block(auto& mesh, Visit&& visit) {
  visit(CellKind::hex, mesh.hexes);
  visit(CellKind::prism, mesh.prisms);
  visit(CellKind::pyramid, mesh.pyramids);
  visit(CellKind::tet, mesh.tets);
}

std::size_t index_of(CellKind kind) {
  return static_cast<std::size_t>(std::find(all_kinds.begin(), all_kinds.end(), kind) - all_kinds.begin());
}

double share(double part, double whole) {
  return whole > 0 ? part / whole : 0;
}

double total_volume(const AssembleStatistics& statistics) {
  double sum = 0;
  for (const auto& kind : statistics.kinds) sum += kind.volume;
  return sum;
}

}  // namespace

std::int64_t AssembleStatistics::cells() const {
  std::int64_t sum = 0;
  for (const auto& kind : kinds) sum += kind.count;
  return sum;
}

void compute_quality(MixedMesh& mesh) {
  for_each_block(mesh, [&](CellKind kind, auto& block) {
    block.quality.clear();
    for (const auto& cell : block.cells) {
      const auto at = corner_points(mesh.points, cell);
      block.quality.push_back(least_corner_scaled_jacobian(kind, std::span<const Vec3>(at).first(cell.size())));
    }
  });
}

KindTable kind_statistics(const MixedMesh& mesh) {
  KindTable result;
  for_each_block(mesh, [&](CellKind kind, const auto& block) {
    auto& statistics = result[index_of(kind)];
    statistics.count = static_cast<std::int64_t>(block.size());
    for (std::size_t i = 0; i < block.size(); ++i) {
      const auto at = corner_points(mesh.points, block.cells[i]);
      const double quality = block.quality[i];
      statistics.volume += cell_volume(kind, std::span<const Vec3>(at).first(block.cells[i].size()));
      statistics.least = i == 0 ? quality : std::min(statistics.least, quality);
      statistics.mean += quality;
      ++statistics.histogram[static_cast<std::size_t>(std::clamp(std::floor(10 * quality), 0.0, 9.0))];
    }
    if (statistics.count > 0) statistics.mean /= static_cast<double>(statistics.count);
  });
  return result;
}

std::vector<PoorCell> poor_cells(const MixedMesh& mesh) {
  std::vector<PoorCell> result;
  for_each_block(mesh, [&](CellKind kind, const auto& block) {
    const double limit = kind == CellKind::hex ? shape::poor_hex : shape::poor_quality;
    const double scale = kind == CellKind::tet ? std::sqrt(2.0) : 1;
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (scale * block.quality[i] >= limit) continue;
      Vec3 middle{};
      for (Vertex v : block.cells[i]) middle += mesh.points[v] * (1.0 / static_cast<double>(block.cells[i].size()));
      result.push_back({kind, static_cast<std::int64_t>(i), block.quality[i], middle});
    }
  });
  return result;
}

namespace {

// The least scaled Jacobian anywhere in a cell, by kind (quality.hpp: to quality_tolerance).
std::array<double, all_kinds.size()> least_inside(const MixedMesh& mesh) {
  std::array<double, all_kinds.size()> result{};
  for_each_block(mesh, [&](CellKind kind, const auto& block) {
    double least = block.size() == 0 ? 0 : 1;
    for (const auto& cell : block.cells) {
      const auto at = corner_points(mesh.points, cell);
      least = std::min(least, least_scaled_jacobian(kind, std::span<const Vec3>(at).first(cell.size())));
    }
    result[index_of(kind)] = least;
  });
  return result;
}

}  // namespace

void count_cells(MixedMesh& mesh, AssembleStatistics& statistics) {
  compute_quality(mesh);
  statistics.kinds = kind_statistics(mesh);
  const auto inside = least_inside(mesh);
  for (std::size_t i = 0; i < inside.size(); ++i) statistics.kinds[i].least_inside = inside[i];
  statistics.poor = poor_cells(mesh);
  statistics.points = static_cast<std::int64_t>(mesh.points.size());
  statistics.triangles = static_cast<std::int64_t>(mesh.triangles.size());
  statistics.quads = static_cast<std::int64_t>(mesh.quads.size());
}

namespace {

nlohmann::ordered_json scaled_jacobian_of(const KindStatistics& kind) {
  return {{"least", kind.least}, {"mean", kind.mean}, {"histogram", kind.histogram}};
}

// "hex before: 0 0 3 10 ...", cells by tenths of the scaled Jacobian.
std::string histogram_line(CellKind kind, const char* when, const KindStatistics& statistics) {
  std::string line = fmt::format("{:>8} {:>6}:", name_of(kind), when);
  for (std::int64_t count : statistics.histogram) line += fmt::format(" {:>7}", count);
  return line;
}

void append_histograms(const AssembleStatistics& statistics, std::vector<std::string>& lines) {
  const ImprovementCounts& made = statistics.improvement;
  lines.push_back(
      fmt::format("smoothing: {} rounds, {} moves, {} flips of tets, {} vertices added at flat tets, {} flat tets "
                  "taken off the boundary; cells by scaled Jacobian, 0 to 1 in tenths",
                  made.rounds, made.moves, made.flips, made.vertices, made.peeled));
  for (std::size_t i = 0; i < all_kinds.size(); ++i) {
    if (statistics.kinds[i].count == 0) continue;
    lines.push_back(histogram_line(all_kinds[i], "before", statistics.before_smoothing[i]));
    lines.push_back(histogram_line(all_kinds[i], "after", statistics.kinds[i]));
  }
}

// `worst` and `limit`: in degrees for the angle.
nlohmann::ordered_json json_of(const MeasureCount& count, double worst, double limit) {
  return {{"worst", worst},
          {"limit", limit},
          {"misses", count.misses},
          {"cells", count.cells},
          {"place", {count.place.x, count.place.y, count.place.z}}};
}

nlohmann::ordered_json json_of(const MeshMeasures& measures) {
  const MeasureLimits limits;
  return {{"faces", measures.faces},
          {"inner_faces", measures.inner_faces},
          {"mean_orthogonality", measures.mean_angle / degree},
          {"orthogonality", json_of(measures.angle, measures.angle.worst / degree, limits.angle / degree)},
          {"weight", json_of(measures.weight, measures.weight.worst, limits.weight)},
          {"determinant", json_of(measures.determinant, measures.determinant.worst, limits.determinant)},
          {"flatness", json_of(measures.flatness, measures.flatness.worst, limits.flatness)}};
}

std::string measures_line(const MeshMeasures& measures) {
  return fmt::format(
      "finite volumes: {} of {} inner faces more than 70 degrees off (at worst {:.1f}), {} of weight below 0.05, "
      "{} faces of flatness below 0.8, {} cells of determinant below 0.001",
      measures.angle.misses, measures.inner_faces, measures.angle.worst / degree, measures.weight.misses,
      measures.flatness.misses, measures.determinant.misses);
}

nlohmann::ordered_json json_of(const layers::LayerCounts& layers) {
  const auto if_any = [&](double value) { return layers.cells > 0 ? nlohmann::ordered_json(value) : nullptr; };
  return {{"facets", layers.facets},
          {"bare_facets", layers.bare},
          {"area", layers.area},
          {"share_of_area_with_layers", share(layers.area_with_layers, layers.area)},
          {"share_of_area_with_all_height", share(layers.area_with_all, layers.area)},
          {"share_of_area_with_some_layers", share(layers.area_with_some, layers.area)},
          {"least_share_of_height", if_any(layers.least_share)},
          {"cells", layers.cells},
          {"scaled_jacobian", {{"least", if_any(layers.least_quality)}, {"mean", if_any(layers.mean_quality)}}}};
}

std::string layers_line(const char* what, const layers::LayerCounts& layers) {
  const std::string cells = fmt::format("{}: {} cells on {:.2f} % of {:g} of wall area", what, layers.cells,
                                        100 * share(layers.area_with_layers, layers.area), layers.area);
  if (layers.cells == 0) return cells;
  return cells + fmt::format(", all of the height on {:.2f} %, scaled Jacobian at least {:.4f}, {:.4f} on average",
                             100 * share(layers.area_with_all, layers.area), layers.least_quality, layers.mean_quality);
}

}  // namespace

std::optional<std::string> layers_warning(const AssembleStatistics& statistics) {
  if (!statistics.layers) return std::nullopt;
  const layers::LayerCounts& layers = *statistics.layers;
  if (!(layers.area > 0)) return "there are no layers: the walls have no area";
  if (layers.cells == 0) return "there are no layers: no line could leave its wall";
  // A facet or two in corners is no news.
  constexpr double worth_telling = 0.99;
  if (layers.area_with_all >= worth_telling * layers.area) return std::nullopt;
  return fmt::format(
      "layers have the height that --first-height and --growth give on {:.1f} % of the walls' area, less on {:.1f} %, "
      "and {:.1f} % has none or not all; the lowest have {:.2g} of it",
      100 * share(layers.area_with_all, layers.area),
      100 * share(layers.area_with_layers - layers.area_with_all, layers.area),
      100 * share(layers.area - layers.area_with_layers, layers.area), layers.least_share);
}

std::optional<std::string> pillow_warning(const AssembleStatistics& statistics) {
  if (!statistics.pillow || statistics.pillow->bare == 0) return std::nullopt;
  return fmt::format("the pillow is missing on {} of {} facets of the boundary: no line could leave them",
                     statistics.pillow->bare, statistics.pillow->facets);
}

nlohmann::ordered_json to_json(const AssembleStatistics& statistics) {
  auto json = nlohmann::ordered_json::object();
  json["cells"] = nlohmann::ordered_json::object();
  const double volume = total_volume(statistics), cells = static_cast<double>(statistics.cells());
  for (std::size_t i = 0; i < all_kinds.size(); ++i) {
    const auto& kind = statistics.kinds[i];
    json["cells"][name_of(all_kinds[i])] = {{"count", kind.count},
                                            {"share_of_number", share(static_cast<double>(kind.count), cells)},
                                            {"volume", kind.volume},
                                            {"share_of_volume", share(kind.volume, volume)},
                                            {"scaled_jacobian", scaled_jacobian_of(kind)}};
    json["cells"][name_of(all_kinds[i])]["scaled_jacobian"]["least_inside"] = kind.least_inside;
    if (statistics.improvement.rounds > 0)
      json["cells"][name_of(all_kinds[i])]["before_smoothing"] = scaled_jacobian_of(statistics.before_smoothing[i]);
  }
  json["points"] = statistics.points;
  json["triangles"] = statistics.triangles;
  json["quads"] = statistics.quads;
  const auto& volumes = statistics.volumes;
  json["volume"] = {{"input", volumes.input},
                    {"cells", volumes.cells},
                    {"bulge_of_boundary_quads", volumes.bulge},
                    {"bulge_of_nonconforming_quads", volumes.open_bulge},
                    {"moved_on_the_surface", volumes.slide},
                    {"flat_tets_taken_off", volumes.peeled},
                    {"drift", volumes.drift}};
  json["boundary"] = {{"vertices_moved", volumes.moved}, {"greatest_deviation", volumes.deviation}};
  json["smoothing"] = {{"rounds", statistics.improvement.rounds},
                       {"moves", statistics.improvement.moves},
                       {"flips_of_tets", statistics.improvement.flips},
                       {"vertices_added_at_flat_tets", statistics.improvement.vertices},
                       {"flat_tets_taken_off", statistics.improvement.peeled}};
  const gap::FewerCells& fewer = statistics.improvement.fewer;
  json["merging"] = {{"vertices_gone", fewer.merged + fewer.closed},
                     {"rooms_filled_anew", fewer.refilled},
                     {"rows_shortened", fewer.rows_shortened},
                     {"hexes_gone", fewer.hexes_gone}};
  json["nonconforming_quads"] = volumes.nonconforming_quads;
  if (statistics.pillow) json["pillow"] = json_of(*statistics.pillow);
  if (statistics.layers) json["layers"] = json_of(*statistics.layers);
  if (statistics.measures) json["finite_volumes"] = json_of(*statistics.measures);
  if (const auto& exchange = statistics.exchange)
    json["exchange"] = {{"hexes_out", exchange->hexes_out},
                        {"hexes_in", exchange->hexes_in},
                        {"open_quads_before", exchange->open_quads_before},
                        {"open_quads_after", exchange->open_quads_after}};
  const auto& counts = statistics.conformity;
  auto given_back = nlohmann::ordered_json::object();
  for (conform::GivenBack reason : conform::all_reasons)
    given_back[conform::name_of(reason)] = counts.given_back[static_cast<std::size_t>(reason)];
  json["conformity"] = {{"prisms_between_cells", statistics.filling_prisms},
                        {"quads_against_tets", counts.open_quads},
                        {"pyramids_merged", counts.merged},
                        {"vertices_added", counts.split},
                        {"slivers_absorbed", counts.absorbed},
                        {"cells_given_back", given_back},
                        {"hex_volume_given_back", counts.volume_given_back}};
  json["poor_cells"] = nlohmann::ordered_json::array();
  for (const auto& cell : statistics.poor)
    json["poor_cells"].push_back({{"kind", name_of(cell.kind)},
                                  {"index", cell.index},
                                  {"scaled_jacobian", cell.quality},
                                  {"middle", {cell.middle.x, cell.middle.y, cell.middle.z}}});
  return json;
}

std::vector<std::string> summary_lines(const AssembleStatistics& statistics) {
  std::vector<std::string> lines;
  const double volume = total_volume(statistics), cells = static_cast<double>(statistics.cells());
  lines.push_back(fmt::format("{:>8} {:>10} {:>9} {:>9} {:>9} {:>9}", "cells", "number", "number %", "volume %",
                              "least SJ", "mean SJ"));
  for (std::size_t i = 0; i < all_kinds.size(); ++i) {
    const auto& kind = statistics.kinds[i];
    if (kind.count == 0) continue;
    lines.push_back(fmt::format("{:>8} {:>10} {:>9.2f} {:>9.2f} {:>9.4f} {:>9.4f}", name_of(all_kinds[i]), kind.count,
                                100 * share(static_cast<double>(kind.count), cells), 100 * share(kind.volume, volume),
                                kind.least, kind.mean));
  }
  const auto& counts = statistics.conformity;
  std::int64_t given_back = 0;
  for (std::int64_t count : counts.given_back) given_back += count;
  lines.push_back(
      fmt::format("{} points, boundary and interfaces of {} quads and {} triangles, {} quads non-conforming",
                  statistics.points, statistics.quads, statistics.triangles, statistics.volumes.nonconforming_quads));
  if (const auto& exchange = statistics.exchange; exchange && exchange->hexes_in > 0)
    lines.push_back(fmt::format("{} hexes exchanged for {} others: {} open quads between cells and tets instead of {}",
                                exchange->hexes_out, exchange->hexes_in, exchange->open_quads_after,
                                exchange->open_quads_before));
  if (statistics.filling_prisms > 0)
    lines.push_back(fmt::format("{} prisms made of tets between the cells", statistics.filling_prisms));
  if (counts.open_quads > 0)
    lines.push_back(fmt::format(
        "{} quads faced tets: {} pyramids merged, {} vertices added, {} cells given back "
        "({:.2f} % of the volume in hexes)",
        counts.open_quads, counts.merged, counts.split, given_back, 100 * share(counts.volume_given_back, volume)));
  if (const gap::FewerCells& fewer = statistics.improvement.fewer; fewer.any())
    lines.push_back(
        fmt::format("{} vertices between the hexes merged into others, {} rooms there filled with better cells",
                    fewer.merged + fewer.closed, fewer.refilled));
  if (const gap::FewerCells& fewer = statistics.improvement.fewer; fewer.rows_shortened > 0)
    lines.push_back(fmt::format("{} rows of hexes that end inside shortened by one hex", fewer.rows_shortened));
  if (!statistics.poor.empty())
    lines.push_back(fmt::format("{} poor cells are left (hexes below 0.1, others below 0.02); --stats lists them",
                                statistics.poor.size()));
  if (statistics.pillow) lines.push_back(layers_line("pillow", *statistics.pillow));
  if (statistics.layers) lines.push_back(layers_line("layers", *statistics.layers));
  if (statistics.measures) lines.push_back(measures_line(*statistics.measures));
  if (statistics.volumes.deviation > 0)
    lines.push_back(
        fmt::format("the boundary lies within {:.3g} of the input's surface", statistics.volumes.deviation));
  if (statistics.improvement.rounds > 0) append_histograms(statistics, lines);
  return lines;
}

}  // namespace hexpipe::assemble
