#pragma once
// Changes the cells around a room of the gap: chosen cells may turn into prisms, go, or come.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/patch.hpp"
#include "tools/assemble/gap/room_filling.hpp"
#include "tools/assemble/gap/tried.hpp"

namespace hexpipe::assemble::gap {

// A cell of the gap, or a chosen one.
struct Piece {
  Solid solid;
  std::int32_t region = 0;
  GapIndex gap = no_index;
  KeptIndex kept = no_index;

  bool has(Vertex v) const;
  bool operator==(const Piece& other) const { return gap == other.gap && kept == other.kept; }
};

Piece piece_of(const GapMesh& gap, GapIndex c);
Piece piece_of(const GapMesh& gap, KeptIndex k);
std::vector<Piece> pieces_at(const GapMesh& gap, Vertex v);

class Reshaper {
 public:
  explicit Reshaper(GapMesh& gap) : gap_(gap), patch_(gap) {}

  enum class Refilled { yes, no, too_large };
  // Fills the room of a cell of the gap and of all tets and pyramids that facets join to it anew (room_filling.hpp).
  // `room` are the cells that it has looked at.
  Refilled refill(GapIndex c, std::vector<GapIndex>& room);
  // Merges pairs of vertices, no two of which have a vertex in common. Cells that both vertices of a pair belong to
  // vanish, or become a prism, pyramid or tet; where that cannot be, the room of the cell is filled anew, with the tets
  // and pyramids that facets join to it. What lies on the surface has to suit already.
  //
  // Both make the change only if fewer cells are no hexes, by price_of_hex_gone for each hex that goes, the objective
  // falls as well, all cells come to their floors (patch.hpp), and no edge becomes short. Inner vertices around make
  // room.
  bool merge(std::span<const VertexMerge> merges);

  std::int64_t hexes_gone() const { return hexes_gone_; }

 private:
  // A piece that changes, and what it becomes, if anything.
  struct Changed {
    Piece piece;
    std::optional<Solid> into;
  };

  Vertex mapped(Vertex v) const;
  bool has_both(const Piece& piece) const;
  std::optional<std::vector<Facet>> mapped_skin(std::span<const Piece> pieces) const;
  bool sort_pieces();
  bool grow_room(std::size_t most);
  bool is_in_room(const Piece& piece) const;
  bool has_wall_inside() const;
  std::optional<std::vector<Vertex>> free_vertices(std::span<const Facet> skin) const;
  void take_out(const Piece& piece);
  bool plan();
  double cost_of_prisms_gone() const;
  void place_stars();
  std::vector<Vertex> moving_vertices() const;
  double least_edge_for(std::span<const Vertex> moving) const;
  bool carry_out();
  bool change();

  GapMesh& gap_;
  Patch patch_;
  TriedRooms failed_;
  std::vector<Vertex> spare_;  // vertices that failed changes have left
  std::int64_t hexes_gone_ = 0;

  // The change that is tried.
  std::vector<VertexMerge> merges_;
  std::vector<Changed> changed_;
  std::vector<Piece> room_;
  RoomFilling filling_;
  std::vector<Vertex> free_;  // inside of the room
  std::vector<GapIndex> out_;
  std::vector<GapCell> in_;
  std::vector<KeptIndex> gone_;  // hexes first
  std::size_t hexes_in_gone_ = 0;
  std::vector<KeptCell> come_;
  std::vector<std::pair<Vertex, Vec3>> middles_;  // of stars
  std::vector<Vertex> around_;
};

}  // namespace hexpipe::assemble::gap
