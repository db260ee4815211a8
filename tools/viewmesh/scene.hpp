#pragma once
// The cells of one mesh that are shown, from any stage of the pipeline, with the values by which they are coloured and
// selected.

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/vec3.hpp"
#include "tools/viewmesh/dislocation_lines.hpp"

namespace hexpipe::viewmesh {

// The measures of finite volumes by which cells are coloured, as common/mesh/mesh_measures.hpp has them.
inline constexpr std::array measure_names{"orthogonality", "weight", "determinant", "flatness"};

// Kinds in the order in which a scene lists its cells.
inline constexpr std::array scene_kinds{CellKind::hex, CellKind::prism, CellKind::pyramid, CellKind::tet};

// A region or a surface.
struct Group {
  std::int32_t tag;
  std::string name;  // that of names.json, otherwise region_1 or surface_3
};

struct Scene {
  // The stage that the cells come from. Candidates overlap; other cells do not.
  enum class Content { result, solution, candidates, mesh };

  Content content = Content::result;
  // The box's centre is the origin and half its diagonal the unit, in single precision as graphics want it.
  std::vector<std::array<float, 3>> points;
  Vec3 centre;
  double unit = 1;
  // Cells of kind scene_kinds[k] are [kind_begin[k], kind_begin[k + 1]), with the corners of each in a row.
  std::array<std::int32_t, 5> kind_begin{};
  std::array<std::vector<std::int32_t>, 4> corners;
  // By cell:
  std::vector<float> quality;        // least scaled Jacobian
  std::vector<std::int32_t> region;  // of candidates: that of their first tet
  std::vector<std::uint8_t> layer;   // 1: touches the surface; 2: touches those; ...
  std::vector<std::int32_t> number;  // in its block of the file, or as a candidate, from 0
  // For meshes, whose cells have neighbours: the worst of each cell's faces, as measure_names, in hundredths of a
  // degree and in ten-thousandths. They are rounded towards the worse, so that no limit of whole such units is met by
  // rounding.
  std::array<std::vector<std::int32_t>, measure_names.size()> measures;
  std::int32_t candidate_count = 0;  // all candidates, shown or not
  // Groups by tag, and the facets that lie on a surface, by cell and facet. Between two regions a facet of both does.
  struct SurfaceFacet {
    std::int32_t cell;
    std::int32_t facet;    // as facet_corners counts them
    std::int32_t surface;  // place in `surfaces`
  };
  std::vector<Group> regions, surfaces;
  std::vector<SurfaceFacet> surface_facets;
  std::vector<Polyline> dislocations;  // where the bundle has them; placed as the points are
  std::array<double, 4> volume{};      // of all cells of a kind, in the mesh's own units
  // The fragments that a search freed, if asked for: the cells of each, ascending.
  std::vector<std::vector<std::int32_t>> fragments;
  std::vector<nlohmann::ordered_json> history;

  std::int32_t cell_count() const { return kind_begin[4]; }
  // The share of the volume that hexes have; none where cells overlap, or no hex can be.
  std::optional<double> hex_share() const;
  int kind_index(std::int32_t cell) const;
  CellKind kind_of(std::int32_t cell) const { return scene_kinds[kind_index(cell)]; }
  std::span<const std::int32_t> corners_of(std::int32_t cell) const;
  Vec3 point(std::int32_t vertex) const { return {points[vertex][0], points[vertex][1], points[vertex][2]}; }
  // Where a point of the mesh is in the scene.
  Vec3 placed(const Vec3& p) const { return (1 / unit) * (p - centre); }
  // The mean of its corners.
  Vec3 middle_of(std::int32_t cell) const;
};

const char* name_of(Scene::Content content);

// The place of the group with this tag, or `groups.size()`.
std::size_t place_of(const std::vector<Group>& groups, std::int32_t tag);

}  // namespace hexpipe::viewmesh
