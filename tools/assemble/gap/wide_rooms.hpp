#pragma once
// Rooms that grow around a poor cell until one vertex sees all of their skin well.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/mesh/vec3.hpp"
#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/skin.hpp"

namespace hexpipe::assemble::gap {

// The room of these cells, and a place for a vertex that is joined to all of its skin.
struct WideRoom {
  std::vector<GapIndex> out;
  std::vector<KeptIndex> chosen;
  std::vector<Facet> skin;
  Vec3 at{};
  double worst = -1;  // the least quality of the cells around a vertex there
};

// A search, best room first. The cells that are worst around the vertex stand on facets of the skin that face each
// other at a small angle: the cell behind one of these joins the room.
class WideRooms {
 public:
  explicit WideRooms(const GapMesh& gap) : gap_(gap) {}

  // Starts again, with the rooms of `poor` and one cell beside it.
  void begin(GapIndex poor);
  // The next room, until so many were found that more are hardly ever of use. The mesh has to be as at begin().
  const WideRoom* next();

 private:
  struct Node {
    WideRoom room;
    double score = 0;
    bool operator<(const Node& other) const { return score < other.score; }
  };

  bool join(const WideRoom& room, const Facet& facet, WideRoom& wider) const;
  bool join_chosen(const WideRoom& room, const Facet& facet, WideRoom& wider) const;
  void place(WideRoom& room, const Vec3& start) const;
  void widen(const WideRoom& room);
  void offer(WideRoom wider, const Vec3& start);

  const GapMesh& gap_;
  std::int32_t region_ = 0;
  std::vector<Node> open_;  // a heap
  std::vector<std::uint64_t> seen_;
  std::optional<WideRoom> current_;
  int rooms_left_ = 0;
};

}  // namespace hexpipe::assemble::gap
