#pragma once
// What is shown: cells of one mesh with what they are coloured and chosen by, taken from any stage of the pipeline.

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/vec3.hpp"
#include "formats/pipeline/stage.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe::viewmesh {

// Kinds in the order in which a scene lists its cells.
inline constexpr std::array scene_kinds{CellKind::hex, CellKind::prism, CellKind::pyramid, CellKind::tet};

struct Scene {
  // Which stage's cells. Candidates overlap; the others do not.
  enum class Content { result, solution, candidates, mesh };

  Content content = Content::result;
  // The box's centre is the origin and half its diagonal the unit, in single precision as graphics want it.
  std::vector<std::array<float, 3>> points;
  Vec3 centre;
  double unit = 1;
  // Cells of kind scene_kinds[k] are [kind_begin[k], kind_begin[k + 1]), with the corners of each in a row.
  std::array<std::int32_t, 5> kind_begin{};
  std::array<std::vector<std::int32_t>, 4> corners;
  // One each a cell.
  std::vector<float> quality;        // least scaled Jacobian
  std::vector<std::int32_t> region;  // of candidates: that of their first tet
  std::vector<std::uint8_t> layer;   // 1: touches the surface; 2: touches those; ...
  std::vector<std::int32_t> number;  // in its block of the file, or as a candidate, from 0
  std::int32_t candidate_count = 0;  // of which cells are candidates, shown or not
  // Parts of the graph that a search freed, if asked for: cells of each fragment, ascending.
  std::vector<std::vector<std::int32_t>> fragments;
  std::vector<nlohmann::ordered_json> history;

  std::int32_t cell_count() const { return kind_begin[4]; }
  int kind_index(std::int32_t cell) const;
  CellKind kind_of(std::int32_t cell) const { return scene_kinds[kind_index(cell)]; }
  std::span<const std::int32_t> corners_of(std::int32_t cell) const;
  Vec3 point(std::int32_t vertex) const { return {points[vertex][0], points[vertex][1], points[vertex][2]}; }
  // The mean of its corners.
  Vec3 middle_of(std::int32_t cell) const;
};

const char* name_of(Scene::Content content);

// The last of the result, the solution, the candidates and the mesh that is there. Throws DataError when nothing is, or
// there are no cells, or candidates come without the mesh that has their points; `source` is named in the message.
Scene::Content last_content(const pipeline::StageData& data, const std::string& source);
Scene make_scene(pipeline::StageData data, Scene::Content content, const std::string& source);

// Gives the scene the fragments that a text lists, the candidates of one a line, counted from 1; tells them by
// Scene::number, of hexes, prisms and pyramids. Throws FormatError at what is no candidate, of those that were there to
// choose from.
void read_fragments(Scene& scene, formats::Input& input);

}  // namespace hexpipe::viewmesh
