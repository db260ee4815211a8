#pragma once
// Fills the room of a few cells anew, with the cells that cost least and no vertex inside.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/assemble/gap_mesh.hpp"

namespace hexpipe {

class Refill {
 public:
  explicit Refill(const GapMesh& gap) : gap_(gap) {}

  // Cells in the place of `out`, which are of one region, that cost less than `most` together, none of them worse than
  // `floor`: the cheapest that a search of bounded length finds. Nothing where there are none, the room has too many
  // corners, or what is to go has a tagged facet or a vertex that has to stay inside.
  std::optional<std::vector<GapCell>> find(std::span<const std::int32_t> out, double floor, double most);

 private:
  using Local = std::uint8_t;  // a corner of the room
  static constexpr Local none = 255;

  // Counter-clockwise as seen from outside of the cell that it needs, the least corner first; a triangle ends in none.
  struct Facet {
    std::array<Local, 4> corners;
    bool operator==(const Facet&) const = default;
    bool is_quad() const { return corners[3] != none; }
    Facet reversed() const;
  };
  struct Piece {
    CellKind kind;
    std::array<Local, 6> corners;
    double cost, volume;
    int closes = 0;  // facets of the front, less those that it adds to it
  };

  static Facet facet_of(std::span<const Local> corners);
  template <class Visit>
  static void for_facets(const Piece& piece, Visit&& visit);
  bool collect_skin(std::span<const std::int32_t> out);
  Local local_of(Vertex v);
  bool judge(Piece& piece);
  void offer(Piece piece, std::vector<Piece>& pieces);
  void collect_pieces(const Facet& facet, std::vector<Piece>& pieces);
  void collect_prisms(const Facet& facet, std::vector<Piece>& pieces);
  void place(const Piece& piece);
  double least_cost_to_come() const;
  void search(double cost, double room);

  const GapMesh& gap_;
  std::int32_t region_ = 0;
  std::vector<Vertex> vertices_;  // of the room
  std::vector<Facet> front_;      // facets that still need a cell
  std::vector<Piece> placed_, best_;
  double floor_ = 0, most_ = 0, rounding_ = 0;
  int steps_left_ = 0;
};

}  // namespace hexpipe
