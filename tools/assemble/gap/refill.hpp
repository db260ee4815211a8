#pragma once
// Fills a room anew with the cells that cost least, without a vertex inside.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/assemble/gap/front.hpp"
#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/skin.hpp"
#include "tools/assemble/gap/tried.hpp"

namespace hexpipe::assemble::gap {

// The measures of cells with corners of one room: each is computed once, however often the search meets it.
class RoomCells {
 public:
  struct Measures {
    double quality = 0, volume = 0, cost = 0;
  };

  // Forgets the last room. `vertices` has to stay. Of a cell below `floor` only the quality is measured.
  void begin(const GapMesh& gap, std::span<const Vertex> vertices, std::int32_t region, double floor);
  Measures of(const SmallCell& cell);
  GapCell made_of(const SmallCell& cell) const;

 private:
  struct Slot {
    std::uint32_t room = 0;  // what is left of another room is no measure of a cell of this one
    std::uint32_t key = 0;
    Measures measures;
  };

  std::array<Vertex, 6> corners_of(const SmallCell& cell) const;
  Measures measured(const SmallCell& small) const;
  Measures of_tet(const SmallCell& cell);

  const GapMesh* gap_ = nullptr;
  std::span<const Vertex> vertices_;
  std::int32_t region_ = 0;
  double floor_ = 0;
  std::uint32_t room_ = 0;
  std::array<Slot, 495> tets_;  // four of twelve corners
  std::array<Slot, 64> others_;
};

class Refill {
 public:
  explicit Refill(const GapMesh& gap) : gap_(gap) {}

  // Finds tets, pyramids and prisms that cost less than `out` and take its place: the cheapest that a search of bounded
  // length meets. Nothing if there are none, if the cells form no room (skin.hpp), or if the room is large. All cells
  // of the gap have to be valid. A room for which there was nothing is not searched again while it is as it was.
  std::optional<std::vector<GapCell>> find(std::span<const GapIndex> out);
  // Cells for the room of `out` once the vertex `from` has become `into`: of at least this quality, which may be
  // negative, and cheaper than `most`, whatever their faces cost. No cells where the skin closes by itself.
  std::optional<std::vector<GapCell>> find_merged(std::span<const GapIndex> out, Vertex from, Vertex into, double floor,
                                                  double most);

 private:
  struct Offer {
    SmallCell cell;
    double cost = 0, volume = 0;
    int closes = 0;  // how many facets of the front it closes, less those that it adds
  };

  bool begin(std::span<const GapIndex> out);
  void begin_search();
  void offer(const SmallCell& cell, std::vector<Offer>& offers);
  void collect_offers(SmallFacet facet, std::size_t most, std::vector<Offer>& offers);
  void collect_prisms(SmallFacet facet, std::vector<Offer>& offers);
  std::vector<Offer> fewest_offers();
  void search(double cost);
  void try_each(const std::vector<Offer>& offers, double cost);
  void compare(double cost);
  bool are_present() const;

  const GapMesh& gap_;
  TriedRooms failed_;
  std::span<const GapIndex> out_;  // while find() runs
  Room room_;
  RoomCells cells_;
  Front front_;
  std::vector<SmallCell> placed_;
  std::vector<GapCell> best_;
  std::vector<Offer> offers_;
  double floor_ = 0, most_ = 0;
  double space_ = 0;  // the volume that is left, and a little for rounding
  int steps_left_ = 0;
  bool merges_ = false;  // while find_merged() runs
};

// Fills the room of a cell and of its neighbours anew. If that finds nothing better, it tries the room of all cells at
// one of the cell's vertices. False if none of these rooms has a better filling.
bool refill_around(GapMesh& gap, Refill& refill, GapIndex c);

}  // namespace hexpipe::assemble::gap
