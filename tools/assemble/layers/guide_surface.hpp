#pragma once
// The input's surface beside the walls, on which lines and their tips stay.

#include <map>
#include <span>
#include <vector>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/layers/walls.hpp"

namespace hexpipe::assemble::layers {

// Where the guides of a line let it go.
struct GuideFreedom {
  enum class Kind { space, face, curve, none };
  Kind kind = Kind::space;
  Vec3 axis{};                     // normal of the face, or direction of the curve; unit
  std::vector<std::int32_t> tags;  // of the face, or of the two beside the curve
  std::vector<Vec3> inwards;       // for each of these faces, from the foot into it
};

// Guides of one tag that turn by less than 40 degrees are one face.
GuideFreedom freedom_of(std::span<const Guide> guides);

class GuideSurface {
 public:
  // `input` outlives this.
  GuideSurface(const TetMesh& input, std::span<const std::int32_t> tags);

  // A point on all of the surfaces near `to`.
  Vec3 nearest(std::span<const std::int32_t> tags, Vec3 to) const;

 private:
  struct Group {
    std::vector<std::int32_t> triangles;
    BoxTree tree;
  };
  Vec3 nearest_on(std::int32_t tag, const Vec3& to) const;

  const TetMesh& input_;
  std::map<std::int32_t, Group> groups_;
};

}  // namespace hexpipe::assemble::layers
