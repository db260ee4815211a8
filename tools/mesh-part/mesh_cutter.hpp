#pragma once
// Cuts the parts of a partition out of a mesh, with the tets around them.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/mesh_part.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::mesh_part {

struct Partition {
  std::vector<std::int32_t> tet_part, point_part;
};

// Makes `parts` parts of about the same number of tets, none without a tet. A point belongs to the part that has most
// of its tets, to the first of several such parts, and to part 0 if it has no tets. The same seed gives the same
// partition. Throws DataError naming `source` when there are fewer tets than parts, or more than METIS can count.
Partition partition(const TetMesh& mesh, const TetAdjacency& adjacency, std::int32_t parts, std::uint64_t seed,
                    const char* source);

struct PartOfMesh {
  TetMesh mesh;
  MeshPart part;
  std::int64_t own_tets = 0;
};

class MeshCutter {
 public:
  // A part gets the tets around it that have a point at most `edges` edges away from a point of its own. findhex looks
  // at three edges (docs/definitions.md 5).
  MeshCutter(const TetMesh& mesh, const TetAdjacency& adjacency, const Partition& partition, std::int32_t parts,
             int edges);

  // `turns`: TetOrientation::turns of the whole.
  PartOfMesh cut(std::int32_t part, const MeshFingerprint& whole, const std::vector<std::int8_t>& turns);

 private:
  void file_triangles();
  // Points at most `edges` edges away from one of the part's own.
  std::vector<std::int32_t> points_within(std::int32_t part, int edges);
  std::vector<TetIndex> tets_of(std::int32_t part);
  std::vector<std::int32_t> triangles_of(std::int32_t part, const std::vector<TetIndex>& tets) const;
  std::vector<std::int32_t> points_of(std::int32_t part, const std::vector<TetIndex>& tets,
                                      const std::vector<std::int32_t>& triangles);

  struct TriangleAtTet {
    TetIndex tet;
    std::int32_t triangle;
    bool operator<(const TriangleAtTet& other) const {
      return tet != other.tet ? tet < other.tet : triangle < other.triangle;
    }
  };
  // Items by part.
  template <class Item>
  struct Lists {
    std::vector<std::int64_t> offsets;
    std::vector<Item> items;
    std::span<const Item> of(std::int32_t part) const {
      return std::span(items).subspan(offsets[part], offsets[part + 1] - offsets[part]);
    }
  };
  template <class Item>
  static Lists<Item> lists_by_part(const std::vector<std::int32_t>& parts_of_items, std::int32_t parts);

  const TetMesh& mesh_;
  const TetAdjacency& adjacency_;
  const Partition& partition_;
  std::int32_t parts_;
  int edges_;
  Lists<Vertex> own_points_;
  Lists<TetIndex> own_tets_;
  std::vector<TriangleAtTet> triangles_;      // sorted
  std::vector<std::int32_t> lone_triangles_;  // beside no tet; part 0 gets them
  // The number of the search that took a point last, and the part that took a tet last.
  std::vector<std::int32_t> point_taken_, tet_taken_, scratch_;
  std::int32_t search_ = 0;
};

}  // namespace hexpipe::mesh_part
