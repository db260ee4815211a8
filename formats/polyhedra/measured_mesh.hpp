#pragma once
// A polyhedral mesh that is being changed, with what OpenFOAM's checkMesh measures of its faces and cells.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/face_measures.hpp"
#include "formats/polyhedra/polyhedral_mesh.hpp"

namespace hexpipe::polyhedra {

// What checkMesh counts as wrong, by its limits, a bit each: cells of low determinant and concave ones; faces that are
// not orthogonal by 90 degrees or more, skew, of low weight, between cells of too different volumes, or with "face
// tets" turned round. And faces over 70 degrees, which it calls severe but not wrong.
using Refusals = std::uint8_t;
enum Refusal : Refusals {
  determinant = 1,
  concave = 2,
  orthogonality_of_90 = 4,
  skewness = 8,
  weight = 16,
  volume_ratio = 32,
  face_tets = 64,
  severe = 128
};
inline constexpr Refusals wrong = 127;

// Keeps the faces of each cell, and shapes, centres and volumes, with the mesh. Faces and cells are added at the end,
// and those that go keep their numbers.
class MeasuredMesh {
 public:
  explicit MeasuredMesh(PolyhedralMesh& mesh);

  const PolyhedralMesh& mesh() const { return mesh_; }
  std::size_t cell_count() const { return cells_.size(); }
  std::span<const std::int32_t> faces_of(std::int32_t cell) const {
    return std::span(pool_).subspan(cells_[cell].begin, static_cast<std::size_t>(cells_[cell].count));
  }
  bool is_alive(std::int32_t cell) const { return cells_[cell].count > 0; }
  const FaceShape& shape(std::int32_t face) const { return shapes_[face]; }
  const Vec3& centre(std::int32_t cell) const { return cells_[cell].centre; }
  double volume(std::int32_t cell) const { return cells_[cell].volume; }
  // Outward from the cell.
  Vec3 area(std::int32_t face, std::int32_t cell) const {
    return mesh_.faces[face].owner == cell ? shapes_[face].area : -shapes_[face].area;
  }

  Refusals refusals_of_cell(std::int32_t cell) const;
  Refusals refusals_of_face(std::int32_t face) const;
  // How far the cell is from having nothing wrong with it: 0 if it has not.
  double trouble(std::int32_t cell) const;
  // The cells and faces with something wrong, in ascending order.
  struct Refused {
    std::vector<std::int32_t> cells, faces;
    bool none() const { return cells.empty() && faces.empty(); }
    std::size_t count() const { return cells.size() + faces.size(); }
  };
  Refused refused() const;
  // The same, from what was refused earlier and what has been measured since this object was made.
  Refused refused_after(const Refused& earlier) const;

  // Changes. After add_face and set_faces, measure() brings the shape of a face or the centre of a cell up to date.
  Vertex add_point(const Vec3& point);
  void set_point(Vertex vertex, const Vec3& place) { mesh_.points[vertex] = place; }
  std::int32_t add_face(std::span<const Vertex> loop, std::int32_t owner, std::int32_t neighbour, std::int32_t surface,
                        bool flipped);
  // Like this one, and after it in order().
  std::int32_t add_cell_after(std::int32_t cell);
  void set_sides(std::int32_t face, std::int32_t owner, std::int32_t neighbour);
  void set_loop(std::int32_t face, std::span<const Vertex> loop);
  void set_surface(std::int32_t face, std::int32_t surface, bool flipped);
  void remove_face(std::int32_t face) { set_sides(face, no_index, no_index); }
  void set_faces(std::int32_t cell, std::span<const std::int32_t> faces);
  void set_hex(std::int32_t cell, bool is_hex) { mesh_.is_hex[cell] = is_hex ? 1 : 0; }
  void measure_face(std::int32_t face);
  void measure_cell(std::int32_t cell);

  // For renumber(): a place for each cell that has faces.
  std::vector<std::int32_t> order() const;

  // What a change of cells and faces that are there has altered, to take it back.
  class Undo;

 private:
  struct Cell {
    std::size_t begin = 0;
    std::int32_t count = 0;
    std::int32_t origin = no_index;  // the cell of the mesh as it was that it is a part of
    Vec3 centre{};
    double volume = 0;
  };

  void measure_first(std::int32_t cell);

  PolyhedralMesh& mesh_;
  std::vector<FaceShape> shapes_;
  std::vector<Cell> cells_;
  std::vector<std::int32_t> pool_;  // the faces of all cells
  // The cells that were measured again, also in changes that were taken back.
  std::vector<std::int32_t> touched_;
  std::vector<std::uint8_t> is_touched_;
};

class MeasuredMesh::Undo {
 public:
  // Notes all cells of the list and their faces.
  Undo(MeasuredMesh& mesh, std::span<const std::int32_t> cells);
  void take_back();

 private:
  MeasuredMesh& mesh_;
  std::vector<std::pair<std::int32_t, Cell>> cells_;
  struct FaceBefore {
    std::int32_t number;
    PolyhedralMesh::Face face;
    FaceShape shape;
  };
  std::vector<FaceBefore> faces_;
  std::vector<std::uint8_t> hexes_;
  std::size_t corner_count_, face_count_, cell_count_, point_count_, pool_size_;
};

}  // namespace hexpipe::polyhedra
