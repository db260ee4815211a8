#pragma once
// TetGen behind one function: makes tetrahedra of a surface, which is kept, and of points inside it.

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
  // If not 0, TetGen gets points and triangles in a shuffled order, given by this number. Where TetGen fails on
  // triangles that are nearly in one plane, it usually succeeds in another order. The result has the order above all
  // the same.
  std::uint64_t shuffle = 0;
  // TetGen treats things that are very near to each other as touching, and then fails or merges points. If strict, it
  // does so only where doubles can hardly tell them apart.
  bool strict = false;
  // If TetGen finds that triangles intersect, it is run once more to name them.
  bool names_intersecting = true;
};

struct TetGenResult {
  // The points of the surface, then those inside, then those that TetGen added. Holes are filled with tets.
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  // If TetGen failed: a sentence on what went wrong, and the triangles that it names as intersecting.
  std::string failure;
  std::vector<Triangle> intersecting;
  double seconds = 0;  // processor time
};

// Runs TetGen in a child process, because TetGen ends processes, throws through frames that free memory twice, and
// prints.
class TetGenRun {
 public:
  // Starts TetGen. The memory that the input refers to must stay until wait() returns. TetGen may take `timeout`
  // seconds. Throws DataError if no child process can be run.
  TetGenRun(const TetGenInput& input, double timeout);
  // Ends TetGen unless wait() was called.
  ~TetGenRun();
  TetGenRun(const TetGenRun&) = delete;
  TetGenRun& operator=(const TetGenRun&) = delete;

  // May be called once. Throws DataError if there is not enough memory.
  TetGenResult wait();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

inline TetGenResult run_tetgen(const TetGenInput& input, double timeout) {
  return TetGenRun(input, timeout).wait();
}

}  // namespace hexpipe::tetmesh::tetgen
