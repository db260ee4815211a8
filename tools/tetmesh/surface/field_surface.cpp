#include "tools/tetmesh/surface/field_surface.hpp"

#include <map>

#include "common/mesh/facet_key.hpp"

namespace hexpipe::tetmesh::surface {

FieldSurface::FieldSurface(const FeatureMesh& mesh, const sizing::SizeField& size,
                           const std::optional<sizing::SizeField>& chord_height) {
  std::map<VertexKey<2>, std::int32_t> joints;  // their numbers by the places of their ends
  const auto joint_of = [&](OpenMesh::HalfedgeHandle h) {
    const VertexKey<2> ends = edge_key(mesh.place(mesh.from_vertex_handle(h)), mesh.place(mesh.to_vertex_handle(h)));
    return joints.try_emplace(ends, static_cast<std::int32_t>(joints.size())).first->second;
  };
  points.reserve(mesh.n_vertices());
  for (const auto v : mesh.vertices()) points.push_back(mesh.position(v));
  triangles.reserve(mesh.n_faces());
  std::vector<geometry::HalfEdge> number(mesh.n_halfedges(), no_index);  // by the mesh's half-edges, those of triangles
  feature.reserve(3 * mesh.n_faces());
  for (const auto f : mesh.faces()) {
    const auto [a, b, c] = mesh.corners(f);
    triangles.push_back({a.idx(), b.idx(), c.idx()});
    auto h = mesh.halfedge_handle(f);  // half_edge_of() starts here, too
    for (int i = 0; i < 3; ++i, h = mesh.next_halfedge_handle(h)) {
      number[h.idx()] = static_cast<geometry::HalfEdge>(feature.size());
      feature.push_back(mesh.is_feature(mesh.edge_handle(h)));
      crest.push_back(mesh.is_crest(mesh.edge_handle(h)));
      joint.push_back(mesh.is_joint(mesh.edge_handle(h)) ? joint_of(h) : no_index);
    }
    centres.push_back((points[a.idx()] + points[b.idx()] + points[c.idx()]) * (1.0 / 3));
    const Vec3 normal = mesh.area_normal(f);
    const double length = norm(normal);
    normals.push_back(normal * (1 / length));
    areas.push_back(length / 2);
    sizes.push_back(size.at(centres.back()));
    if (chord_height) chord_heights.push_back(chord_height->at(centres.back()));
    is_interface.push_back(mesh.is_interface(f));
  }
  twins.resize(3 * triangles.size());
  for (const auto h : mesh.halfedges()) {
    const geometry::HalfEdge twin = number[mesh.opposite_halfedge_handle(h).idx()];
    if (number[h.idx()] != no_index) twins[number[h.idx()]] = twin == no_index ? number[h.idx()] : twin;
  }
  alongs.reserve(twins.size());
  inwards.reserve(twins.size());
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
    const Vec3 edge = edge_vector(h);
    alongs.push_back(unit(edge));
    inwards.push_back(unit(cross(normals[geometry::triangle_of(h)], edge)));
  }
}

std::vector<AreaSample> FieldSurface::samples(double least_squares) const {
  std::vector<AreaSample> samples;
  double area = 0, squares = 0;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(triangles.size()); ++f) {
    area += areas[f];
    squares += squares_of_size(f);
    if (squares < least_squares) continue;
    samples.push_back({f, area, squares});
    area = squares = 0;
  }
  return samples;
}

geometry::HalfEdge half_edge_of(const FeatureMesh& mesh, OpenMesh::HalfedgeHandle h) {
  const auto f = mesh.face_handle(h);
  geometry::HalfEdge number = 3 * f.idx();
  for (auto g = mesh.halfedge_handle(f); g != h; g = mesh.next_halfedge_handle(g)) ++number;
  return number;
}

TangentFrame::TangentFrame(const FieldSurface& surface, std::int32_t triangle) {
  x = unit(surface.edge_vector(3 * triangle));
  y = cross(surface.normals[triangle], x);
}

}  // namespace hexpipe::tetmesh::surface
