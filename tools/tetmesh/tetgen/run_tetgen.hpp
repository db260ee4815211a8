#pragma once
// TetGen behind one function: a surface that is kept and points inside it become tetrahedra.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::tetgen {

struct TetGenInput {
  std::span<const Vec3> surface_points;
  std::span<const Triangle> triangles;  // of one or more closed surfaces
  std::span<const Vec3> interior_points;
  // Other than 0: TetGen is given points and triangles in a shuffled order, this one. Where it fails on triangles that
  // are nearly in one plane, it usually succeeds in another order. The result is in the order above all the same.
  std::uint64_t shuffle = 0;
  // TetGen takes what is very near for touching, and then fails, or merges points. With this it does only where doubles
  // can hardly tell them apart.
  bool strict = false;
  // Where it finds that triangles intersect, it is run once more to name them.
  bool names_intersecting = true;
};

struct TetGenResult {
  // The points of the surface, then those inside, then those that TetGen added. Holes are filled.
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  // Where it failed: what went wrong, in a sentence, and the triangles that TetGen names as intersecting.
  std::string failure;
  std::vector<Triangle> intersecting;
  double seconds = 0;  // of the processor
};

// TetGen at work in a child process: it ends processes, throws through frames that free twice, and prints.
class TetGenRun {
 public:
  // Starts it; what the input names has to stand until it was waited for. It may take `timeout` seconds. Throws
  // DataError when no child process can be run.
  TetGenRun(const TetGenInput& input, double timeout);
  // Ends it, unless it was waited for.
  ~TetGenRun();
  TetGenRun(const TetGenRun&) = delete;
  TetGenRun& operator=(const TetGenRun&) = delete;

  // Once. Throws DataError when it has not enough memory.
  TetGenResult wait();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

inline TetGenResult run_tetgen(const TetGenInput& input, double timeout) {
  return TetGenRun(input, timeout).wait();
}

}  // namespace hexpipe::tetmesh::tetgen
