#pragma once
// Fills a room anew with the cells that cost least, without a vertex inside.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/skin.hpp"

namespace hexpipe::assemble::gap {

class Refill {
 public:
  explicit Refill(const GapMesh& gap) : gap_(gap) {}

  // Finds tets, pyramids and prisms that cost less than `out` and take its place: the cheapest that a search of bounded
  // length meets. Nothing if there are none, if the cells form no room (skin.hpp), or if the room is large. All cells
  // of the gap have to be valid.
  std::optional<std::vector<GapCell>> find(std::span<const GapIndex> out);

 private:
  struct Offer {
    GapCell cell;
    double cost = 0, volume = 0;
    int closes = 0;  // how many facets of the front it closes, less those that it adds
  };

  void offer(CellKind kind, const std::array<Vertex, 6>& corners, std::vector<Offer>& offers) const;
  void collect_offers(const Facet& facet, std::size_t most, std::vector<Offer>& offers) const;
  void collect_prisms(const Facet& facet, std::vector<Offer>& offers) const;
  std::vector<Offer> fewest_offers() const;
  void place(const Offer& offer);
  void search(double cost);

  const GapMesh& gap_;
  std::span<const GapIndex> out_;  // while find() runs
  Room room_;
  std::vector<Facet> front_;  // facets that still need a cell
  std::vector<GapCell> placed_, best_;
  double floor_ = 0, most_ = 0;
  double space_ = 0;  // the volume that is left, and a little for rounding
  int steps_left_ = 0;
};

// Fills the room of a cell and of its neighbours anew. If that finds nothing better, it tries the room of all cells at
// one of the cell's vertices. False if none of these rooms has a better filling.
bool refill_around(GapMesh& gap, Refill& refill, GapIndex c);

}  // namespace hexpipe::assemble::gap
