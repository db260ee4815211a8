#include "formats/polyhedra/polyhedral_mesh.hpp"

#include <algorithm>
#include <utility>

namespace hexpipe::polyhedra {
namespace {

void drop_unused_points(PolyhedralMesh& mesh) {
  std::vector<Vertex> place(mesh.points.size(), no_index);
  for (const PolyhedralMesh::Face& face : mesh.faces)
    for (const Vertex v : mesh.corners_of(face)) place[v] = Vertex(0);
  std::int32_t count = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] == no_index) continue;
    mesh.points[static_cast<std::size_t>(count)] = mesh.points[i];
    place[i] = Vertex(count++);
  }
  mesh.points.resize(static_cast<std::size_t>(count));
  for (const PolyhedralMesh::Face& face : mesh.faces)
    for (Vertex& v : std::span(mesh.corners).subspan(face.begin, static_cast<std::size_t>(face.count))) v = place[v];
}

}  // namespace

std::int32_t PolyhedralMesh::add_face(std::span<const Vertex> loop, std::int32_t owner, std::int32_t neighbour) {
  faces.push_back({corners.size(), static_cast<std::int32_t>(loop.size()), owner, neighbour});
  corners.insert(corners.end(), loop.begin(), loop.end());
  return static_cast<std::int32_t>(faces.size()) - 1;
}

void renumber(PolyhedralMesh& mesh, std::span<const std::int32_t> order) {
  std::erase_if(mesh.faces, [](const PolyhedralMesh::Face& face) { return face.owner == no_index; });
  for (PolyhedralMesh::Face& face : mesh.faces) {
    face.owner = order[static_cast<std::size_t>(face.owner)];
    if (!face.is_inner()) continue;
    face.neighbour = order[static_cast<std::size_t>(face.neighbour)];
    if (face.owner < face.neighbour) continue;
    std::swap(face.owner, face.neighbour);
    face.flipped = !face.flipped;
    const auto begin = mesh.corners.begin() + static_cast<std::ptrdiff_t>(face.begin);
    std::reverse(begin, begin + face.count);
  }
  const auto count = static_cast<std::size_t>(std::ranges::count_if(order, [](std::int32_t i) { return i >= 0; }));
  std::vector<std::int32_t> regions(count);
  std::vector<std::uint8_t> is_hex(count);
  for (std::size_t cell = 0; cell < order.size(); ++cell) {
    if (order[cell] < 0) continue;
    regions[static_cast<std::size_t>(order[cell])] = mesh.regions[cell];
    is_hex[static_cast<std::size_t>(order[cell])] = mesh.is_hex[cell];
  }
  mesh.regions = std::move(regions), mesh.is_hex = std::move(is_hex);
  drop_unused_points(mesh);
}

}  // namespace hexpipe::polyhedra
