#include <algorithm>
#include <cmath>

#include "common/mesh/facet_key.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe::assemble::shape {
namespace {

// The sine of the angle up to which two normals count as those of one plane. STL files hold floats: a slanted plane in
// one is this uneven, and a vertex that moves in it by an edge length changes the volume by this fraction of the cube
// of that length.
constexpr double plane_tolerance = 1e-6;

// A tagged triangle, or a triangle of a tagged quad, as one of its vertices sees it.
struct Fan {
  Vec3 normal;  // unit
  std::int32_t tag;
  Vertex from, to;
};

struct Fans {
  std::vector<std::int64_t> offsets;
  std::vector<Fan> fans;

  std::span<const Fan> of(Vertex v) const { return std::span(fans).subspan(offsets[v], offsets[v + 1] - offsets[v]); }
};

// visit(vertex, next, last, tag) for every corner of every tagged facet.
template <class Visit>
void for_each_facet_corner(const MixedMesh& mesh, Visit&& visit) {
  auto each = [&](const auto& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      const auto& facet = block.cells[i];
      for (std::size_t k = 0; k < facet.size(); ++k)
        visit(facet[k], facet[(k + 1) % facet.size()], facet[(k + facet.size() - 1) % facet.size()], block.tags[i]);
    }
  };
  each(mesh.triangles);
  each(mesh.quads);
}

// A quad may be warped: each of its corners takes its own normal.
Fans collect_fans(const MixedMesh& mesh) {
  Fans result;
  result.offsets.assign(mesh.points.size() + 1, 0);
  for_each_facet_corner(mesh, [&](Vertex v, Vertex, Vertex, std::int32_t) { ++result.offsets[v + 1]; });
  for (std::size_t v = 1; v < result.offsets.size(); ++v) result.offsets[v] += result.offsets[v - 1];
  result.fans.resize(static_cast<std::size_t>(result.offsets.back()));
  std::vector<std::int64_t> next_fan(result.offsets.begin(), result.offsets.end() - 1);
  for_each_facet_corner(mesh, [&](Vertex v, Vertex next, Vertex last, std::int32_t tag) {
    const Vec3 normal = cross(mesh.points[next] - mesh.points[v], mesh.points[last] - mesh.points[v]);
    result.fans[next_fan[v]++] = {unit(normal), tag, next, last};
  });
  return result;
}

// Vertices of warped quads stay, because moving one changes the volume under the quad.
std::vector<bool> vertices_of_warped_quads(const MixedMesh& mesh) {
  std::vector<bool> result(mesh.points.size());
  for (const auto& quad : mesh.quads.cells) {
    const Vec3 o = mesh.points[quad[0]];
    const Vec3 normal = cross(mesh.points[quad[1]] - o, mesh.points[quad[2]] - o);
    const Vec3 other = mesh.points[quad[3]] - o;
    if (std::abs(dot(normal, other)) > plane_tolerance * norm(normal) * norm(other))
      for (Vertex v : quad) result[v] = true;
  }
  return result;
}

bool is_parallel(const Vec3& unit, const Vec3& other) {
  return norm_squared(cross(unit, other)) <= plane_tolerance * plane_tolerance * norm_squared(other);
}

// Whether every edge at the vertex lies between two facets, or along `line`.
bool edges_are_paired(std::span<const Fan> fans, const MixedMesh& mesh, Vertex v, const Vec3& line) {
  std::vector<Vertex> ends;
  for (const Fan& fan : fans) ends.push_back(fan.from), ends.push_back(fan.to);
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t next = i;
    while (next < ends.size() && ends[next] == ends[i]) ++next;
    if (next - i != 2 && !(norm_squared(line) > 0 && is_parallel(line, mesh.points[ends[i]] - mesh.points[v])))
      return false;
    i = next;
  }
  return true;
}

Freedom freedom_of(std::span<const Fan> fans, const MixedMesh& mesh, Vertex v) {
  constexpr Freedom fixed{Freedom::Kind::none, {}};
  if (fans.empty()) return {};
  // At most two planes, each with the tag of its first facet.
  std::vector<const Fan*> planes;
  for (const Fan& fan : fans) {
    if (norm_squared(fan.normal) == 0) return fixed;
    const auto plane =
        std::find_if(planes.begin(), planes.end(), [&](const Fan* p) { return is_parallel(p->normal, fan.normal); });
    if (plane == planes.end())
      planes.push_back(&fan);
    else if ((*plane)->tag != fan.tag)
      return fixed;
  }
  if (planes.size() > 2) return fixed;
  if (planes.size() == 1) {
    if (!edges_are_paired(fans, mesh, v, {})) return fixed;
    return {Freedom::Kind::plane, planes[0]->normal};
  }
  const Vec3 line = cross(planes[0]->normal, planes[1]->normal);
  const Vec3 direction = unit(line);
  if (!edges_are_paired(fans, mesh, v, direction)) return fixed;
  return {Freedom::Kind::line, direction};
}

}  // namespace

std::vector<Freedom> vertex_freedoms(const MixedMesh& mesh) {
  const Fans fans = collect_fans(mesh);
  const std::vector<bool> warped = vertices_of_warped_quads(mesh);
  std::vector<Freedom> result(mesh.points.size());
  for (std::size_t v = 0; v < result.size(); ++v) {
    const auto vertex = static_cast<Vertex>(v);
    result[v] = warped[v] ? Freedom{Freedom::Kind::none, {}} : freedom_of(fans.of(vertex), mesh, vertex);
  }
  return result;
}

}  // namespace hexpipe::assemble::shape
