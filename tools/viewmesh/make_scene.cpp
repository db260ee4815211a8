#include "tools/viewmesh/make_scene.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <unordered_map>

#include "common/mesh/mesh_measures.hpp"
#include "common/mesh/quality.hpp"
#include "common/run/error.hpp"
#include "formats/streams/text_scanner.hpp"
#include "tools/viewmesh/facets.hpp"
#include "tools/viewmesh/groups.hpp"

namespace hexpipe::viewmesh {
namespace {

int index_of(CellKind kind) {
  return static_cast<int>(std::find(scene_kinds.begin(), scene_kinds.end(), kind) - scene_kinds.begin());
}

// Takes cells of any kind in any order; a scene has them by kind.
class CellCollector {
 public:
  void add(CellKind kind, std::span<const Vertex> corners, double quality, std::int32_t region, std::int32_t number) {
    Block& block = blocks_[index_of(kind)];
    block.corners.insert(block.corners.end(), corners.begin(), corners.end());
    block.quality.push_back(static_cast<float>(quality));
    block.region.push_back(region);
    block.number.push_back(number);
  }

  void give_to(Scene& scene) {
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      Block& block = blocks_[k];
      scene.kind_begin[k + 1] = scene.kind_begin[k] + static_cast<std::int32_t>(block.number.size());
      scene.corners[k] = std::move(block.corners);
      scene.quality.insert(scene.quality.end(), block.quality.begin(), block.quality.end());
      scene.region.insert(scene.region.end(), block.region.begin(), block.region.end());
      scene.number.insert(scene.number.end(), block.number.begin(), block.number.end());
    }
  }

 private:
  struct Block {
    std::vector<std::int32_t> corners, region, number;
    std::vector<float> quality;
  };
  std::array<Block, 4> blocks_;
};

double quality_of(CellKind kind, std::span<const Vec3> points, std::span<const Vertex> corners) {
  const auto at = corner_points(points, corners);
  return least_corner_scaled_jacobian(kind, std::span(at).first(corners.size()));
}

template <int Corners>
void collect(CellKind kind, const CellBlock<Corners>& block, std::span<const Vec3> points, CellCollector& cells) {
  for (std::size_t i = 0; i < block.size(); ++i)
    cells.add(kind, block.cells[i], block.quality.empty() ? quality_of(kind, points, block.cells[i]) : block.quality[i],
              block.tags[i], static_cast<std::int32_t>(i));
}

void collect(const MixedMesh& mesh, CellCollector& cells) {
  collect(CellKind::hex, mesh.hexes, mesh.points, cells);
  collect(CellKind::prism, mesh.prisms, mesh.points, cells);
  collect(CellKind::pyramid, mesh.pyramids, mesh.points, cells);
  collect(CellKind::tet, mesh.tets, mesh.points, cells);
}

void collect(const Candidates& candidates, const TetMesh& mesh, std::size_t i, CellCollector& cells) {
  const auto tets = candidates.interior_tets_of(i);
  cells.add(candidates.kind[i], candidates.corners_of(i), candidates.quality[i],
            tets.empty() ? 0 : mesh.tet_tags[tets.front()], static_cast<std::int32_t>(i));
}

// The chosen candidates, and the tets that none of them takes.
void collect(const graph::IndependentSet& chosen, const Candidates& candidates, const TetMesh& mesh,
             const std::string& source, CellCollector& cells) {
  std::vector<char> taken(mesh.tets.size());
  for (const auto i : chosen) {
    if (i < 0 || static_cast<std::size_t>(i) >= candidates.size())
      throw DataError::at(source, "expected candidates from 1 to {}, found {}", candidates.size(), std::int64_t{i} + 1);
    collect(candidates, mesh, i, cells);
    for (const auto tet : candidates.interior_tets_of(i)) taken[tet] = 1;
    for (const auto tet : candidates.boundary_tets_of(i)) taken[tet] = 1;
  }
  for (std::size_t i = 0; i < mesh.tets.size(); ++i)
    if (!taken[i])
      cells.add(CellKind::tet, mesh.tets[i], quality_of(CellKind::tet, mesh.points, mesh.tets[i]), mesh.tet_tags[i],
                static_cast<std::int32_t>(i));
}

std::vector<TaggedTriangle> surface_of(const MixedMesh& mesh) {
  std::vector<TaggedTriangle> surface;
  append_tagged(mesh.triangles.cells, mesh.triangles.tags, surface);
  append_tagged(mesh.quads.cells, mesh.quads.tags, surface);
  return surface;
}

std::vector<TaggedTriangle> surface_of(const TetMesh& mesh) {
  std::vector<TaggedTriangle> surface;
  append_tagged(mesh.triangles, mesh.triangle_tags, surface);
  return surface;
}

std::array<double, 4> volumes_of(const Scene& scene, std::span<const Vec3> points) {
  std::array<double, 4> volume{};
  for (std::int32_t cell = 0; cell < scene.cell_count(); ++cell) {
    const auto corners = scene.corners_of(cell);
    const auto at = corner_points(points, corners);
    volume[scene.kind_index(cell)] += cell_volume(scene.kind_of(cell), std::span(at).first(corners.size()));
  }
  return volume;
}

std::vector<std::int32_t> rounded_down(const std::vector<double>& values, double unit) {
  std::vector<std::int32_t> result;
  result.reserve(values.size());
  for (const double value : values) result.push_back(static_cast<std::int32_t>(std::floor(value * unit)));
  return result;
}

// `mesh` has the cells of the scene, in its order.
void measure(const MixedMesh& mesh, Scene& scene) {
  MeasuresOfCells measures = measure_cells(mesh);
  for (double& cosine : measures.orthogonality) cosine = -std::acos(std::clamp(cosine, -1.0, 1.0)) / degree;
  scene.measures = {rounded_down(measures.orthogonality, 100), rounded_down(measures.weight, 1e4),
                    rounded_down(measures.determinant, 1e4), rounded_down(measures.flatness, 1e4)};
  for (std::int32_t& angle : scene.measures[0]) angle = -angle;
}

void collect(const TetMesh& mesh, CellCollector& cells) {
  for (std::size_t i = 0; i < mesh.tets.size(); ++i)
    cells.add(CellKind::tet, mesh.tets[i], quality_of(CellKind::tet, mesh.points, mesh.tets[i]), mesh.tet_tags[i],
              static_cast<std::int32_t>(i));
}

// Throws DataError when roles are missing that the content needs; the result needs no other role.
void expect_shown(const pipeline::StageData& data, Scene::Content content, const std::string& source) {
  const auto expect = [&](bool there, const char* member) {
    if (!there) throw DataError::at(source, "expected {} to show the {}, found none", member, name_of(content));
  };
  expect(data.mesh.has_value(), "the tet mesh");
  if (content == Scene::Content::mesh) return;
  expect(data.candidates.has_value(), "candidates");
  if (content == Scene::Content::solution) expect(data.solution.has_value(), "a solution");
}

// Points that no cell uses do not widen the box.
void place(const std::vector<Vec3>& points, Scene& scene) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low{infinity, infinity, infinity}, high = -low;
  for (const auto& block : scene.corners)
    for (const auto vertex : block) {
      const Vec3& p = points[vertex];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  scene.centre = 0.5 * low + 0.5 * high;
  const double half = norm(0.5 * high - 0.5 * low);
  if (half > 0 && std::isfinite(half)) scene.unit = half;
  scene.points.reserve(points.size());
  for (const Vec3& p : points) {
    const auto [x, y, z] = scene.placed(p);
    scene.points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
  }
}

void fill(Scene& scene, CellCollector& cells, const std::vector<Vec3>& points, const std::string& source) {
  cells.give_to(scene);
  if (scene.cell_count() == 0)
    throw DataError::at(source, "expected cells in the {}, found none", name_of(scene.content));
  place(points, scene);
}

// Only what finding facets needs: candidates overlap, so the tets tell where the surface is.
Scene tets_of(const TetMesh& mesh) {
  Scene scene;
  scene.points.resize(mesh.points.size());
  scene.kind_begin[4] = static_cast<std::int32_t>(mesh.tets.size());
  for (const Tet& tet : mesh.tets) scene.corners[3].insert(scene.corners[3].end(), tet.begin(), tet.end());
  return scene;
}

// All but the dislocations.
Scene scene_of_cells(pipeline::StageData& data, Scene::Content content, const std::string& source) {
  Scene scene;
  scene.content = content;
  scene.history = std::move(data.history);
  CellCollector cells;
  if (content == Scene::Content::result) {
    if (!data.result) throw DataError::at(source, "expected a result to show, found none");
    collect(*data.result, cells);
    fill(scene, cells, data.result->points, source);
    scene.layer = layers_from_surface(scene, surface_points(scene));
    scene.volume = volumes_of(scene, data.result->points);
    measure(*data.result, scene);
    find_groups(data.names, surface_of(*data.result), scene);
    return scene;
  }
  expect_shown(data, content, source);
  if (data.candidates) scene.candidate_count = static_cast<std::int32_t>(data.candidates->size());
  if (content == Scene::Content::solution) collect(*data.solution, *data.candidates, *data.mesh, source, cells);
  if (content == Scene::Content::candidates)
    for (std::size_t i = 0; i < data.candidates->size(); ++i) collect(*data.candidates, *data.mesh, i, cells);
  if (content == Scene::Content::mesh) collect(*data.mesh, cells);
  fill(scene, cells, data.mesh->points, source);
  scene.layer = layers_from_surface(scene, surface_points(tets_of(*data.mesh)));
  scene.volume = volumes_of(scene, data.mesh->points);
  find_groups(data.names, surface_of(*data.mesh), scene);
  if (content == Scene::Content::mesh) measure(to_mixed_mesh(std::move(*data.mesh)), scene);
  return scene;
}

}  // namespace

Scene::Content last_content(const pipeline::StageData& data, const std::string& source) {
  if (data.result) return Scene::Content::result;
  if (data.solution && data.candidates) return Scene::Content::solution;
  if (data.candidates) return Scene::Content::candidates;
  if (data.mesh) return Scene::Content::mesh;
  throw DataError::at(source, "expected a mesh to show, found none");
}

Scene make_scene(pipeline::StageData data, Scene::Content content, const std::string& source) {
  Scene scene = scene_of_cells(data, content, source);
  scene.dislocations = join_segments(data.dislocations);
  for (Polyline& line : scene.dislocations)
    for (Vec3& p : line) p = scene.placed(p);
  return scene;
}

void read_fragments(Scene& scene, formats::Input& input) {
  // Tets, which come last, are no candidates.
  std::unordered_map<std::int32_t, std::int32_t> cell_of;
  for (std::int32_t cell = 0; cell < scene.kind_begin[3]; ++cell) cell_of[scene.number[cell]] = cell;
  std::istringstream lines(input.read_all());
  long line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    std::vector<std::int32_t>& fragment = scene.fragments.emplace_back();
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      std::int32_t number = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      if (error != std::errc() || end != word.data() + word.size() || number < 1 || number > scene.candidate_count)
        throw FormatError(input.name(), line_number,
                          fmt::format("expected the number of a candidate, 1 to {}, found {}", scene.candidate_count,
                                      formats::quote_found(word)));
      // A solution shows only the chosen candidates.
      if (const auto found = cell_of.find(number - 1); found != cell_of.end()) fragment.push_back(found->second);
    }
    std::sort(fragment.begin(), fragment.end());
  }
}

}  // namespace hexpipe::viewmesh
