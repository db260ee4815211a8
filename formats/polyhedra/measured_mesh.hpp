#pragma once
// A polyhedral mesh that can be changed, with what OpenFOAM's checkMesh measures of its faces and cells.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/face_measures.hpp"
#include "formats/polyhedra/polyhedral_mesh.hpp"

namespace hexpipe::polyhedra {

// What checkMesh refuses of a cell or a face, by its limits, a bit for each: cells of a low determinant and concave
// ones; faces that are non-orthogonal by 90 degrees or more, skew, of low weight, between cells of too different
// volumes, or with inverted "face tets" (of a corner triangle and a cell centre). These are wrong: checkMesh does not
// say "Mesh OK" to them. Faces over 70 degrees it calls severe, and accepts.
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

// The mesh with the faces of each cell, the shape of each face, and the centre and volume of each cell. New faces and
// cells come at the end; the numbers of removed ones are not used again.
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
  // The face's area vector, outward from the cell.
  Vec3 area(std::int32_t face, std::int32_t cell) const {
    return mesh_.faces[face].owner == cell ? shapes_[face].area : -shapes_[face].area;
  }

  Refusals refusals_of_cell(std::int32_t cell) const;
  Refusals refusals_of_face(std::int32_t face) const;
  // How far the cell is from being accepted, for a descent: 0 if nothing is wrong with it. It sums how much too low the
  // determinant is, as a share of the limit, and by which sines pairs of faces are concave.
  double trouble(std::int32_t cell) const;
  // Cells and faces with something wrong, in ascending order.
  struct Refused {
    std::vector<std::int32_t> cells, faces;
    bool none() const { return cells.empty() && faces.empty(); }
    std::size_t count() const { return cells.size() + faces.size(); }
  };
  // All of the mesh, judged in parallel.
  Refused refused() const;
  // The same, but only `earlier` and cells that have changed since this object was made are judged.
  Refused refused_after(const Refused& earlier) const;

  // Changes. The caller keeps faces and cells consistent. After a change of points, loops or sides, measure_face()
  // brings the shape of a face up to date, and then measure_cell() the centre and volume of a cell.
  Vertex add_point(const Vec3& point);
  void set_point(Vertex vertex, const Vec3& place) { mesh_.points[vertex] = place; }
  std::int32_t add_face(std::span<const Vertex> loop, std::int32_t owner, std::int32_t neighbour, std::int32_t surface,
                        bool flipped);
  // Adds a cell without faces, of the same region, which comes right after this one in order().
  std::int32_t add_cell_after(std::int32_t cell);
  void set_sides(std::int32_t face, std::int32_t owner, std::int32_t neighbour);
  void set_loop(std::int32_t face, std::span<const Vertex> loop);
  void set_surface(std::int32_t face, std::int32_t surface, bool flipped);
  void remove_face(std::int32_t face) { set_sides(face, no_index, no_index); }
  void set_faces(std::int32_t cell, std::span<const std::int32_t> faces);
  void set_hex(std::int32_t cell, bool is_hex) { mesh_.is_hex[cell] = is_hex ? 1 : 0; }
  void measure_face(std::int32_t face);
  void measure_cell(std::int32_t cell);
  // How often measure_cell() was called: the work of all changes so far, also of those that were taken back.
  std::int64_t measurements() const { return measurements_; }

  // For renumber(): a number for each cell that has faces.
  std::vector<std::int32_t> order() const;

  // Takes a change back.
  class Undo;

 private:
  struct Cell {
    std::size_t begin = 0;
    std::int32_t count = 0;
    std::int32_t origin = no_index;  // the cell of the first mesh that it is a part of
    Vec3 centre{};
    double volume = 0;
  };

  void update_shape(std::int32_t cell);

  PolyhedralMesh& mesh_;
  std::vector<FaceShape> shapes_;
  std::vector<Cell> cells_;
  std::vector<std::int32_t> pool_;  // the faces of all cells; lists that were replaced stay in it
  // The cells that were measured again, also those of changes that were taken back.
  std::vector<std::int32_t> touched_;
  std::vector<std::uint8_t> is_touched_;
  std::int64_t measurements_ = 0;
};

class MeasuredMesh::Undo {
 public:
  // Remembers the cells and their faces. Everything added later is removed by take_back(); points that were moved with
  // set_point() are not restored.
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
