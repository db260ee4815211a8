#pragma once
// Closes the gap between two vertices of chosen cells: they become one, and the cells of the gap around it are new.

#include <span>
#include <vector>

#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/patch.hpp"
#include "tools/assemble/gap/refill.hpp"

namespace hexpipe::assemble::gap {

class GapCloser {
 public:
  explicit GapCloser(GapMesh& gap) : gap_(gap), refill_(gap), patch_(gap) {}

  // Whether chosen cells let `from` become `into`: none has both, and none that changes is one that several pieces of a
  // mesh have.
  bool may_close(Vertex from, Vertex into) const;
  // Makes the merge if the objective falls, the cells of the gap come to their floors, and the chosen ones to least_hex
  // (patch.hpp) or what they had. Inner vertices around make room. What lies on the surface has to suit already.
  bool close(const VertexMerge& merge);

 private:
  std::vector<GapIndex> hole_of(const VertexMerge& merge);
  bool suits_chosen(const VertexMerge& merge);
  bool fill(const VertexMerge& merge, std::span<const GapIndex> room);
  bool carry_out(const VertexMerge& merge, std::span<const GapIndex> out, std::vector<GapCell> in);
  GapCell moved(GapIndex c, const VertexMerge& merge) const;

  GapMesh& gap_;
  Refill refill_;
  Patch patch_;
};

}  // namespace hexpipe::assemble::gap
