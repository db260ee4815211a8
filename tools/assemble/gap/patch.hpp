#pragma once
// A copy of a few vertices inside the mesh, with all cells around them. A change is tried on the copy, and carried out
// in the mesh only if it turns out well.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::gap {

// Chosen cells at `from` get the vertex `into` in its place.
struct VertexMerge {
  Vertex from = no_index, into = no_index;
  Vec3 at{};              // where `into` goes
  bool is_fixed = false;  // it stays there, because it is on the surface
};

// Two vertices of which one is inside at least: one on the surface stays where it is.
VertexMerge merge_inside(const GapMesh& gap, Vertex a, Vertex b);

// A change of the gap: which cells go, and which come.
struct Replacement {
  std::span<const GapIndex> out;
  std::span<const GapCell> in;
  double floor = 0;  // the least quality of a cell that may come
  // All cells of the gap at each `from` are among `out`, and chosen cells that have both vertices are among `gone`.
  // Each `into` is among the moving vertices if it moves.
  std::span<const VertexMerge> merges{};
  std::span<const KeptIndex> gone{};  // chosen cells that go
  std::span<const KeptCell> come{};   // hexes that come, and count as chosen
};

// A change that raises the worst cell by less is not worth it.
inline constexpr double least_rise = 1e-3;

class Patch {
 public:
  // No cell of the gap falls below `floor` that was not below before.
  explicit Patch(const GapMesh& gap, double floor = least_quality) : gap_(gap), floor_(floor) {}

  // The cells at `moving` after the change.
  void take(std::span<const Vertex> moving, const Replacement& replacement);
  void place(Vertex v, const Vec3& at) { points_[local_of(v)] = at; }

  // Moves each vertex in turn where the worst cell around it is below `goal` and becomes better. Ends after `rounds`
  // rounds, or after the second or a later one that did not raise the least quality. Chosen cells stay valid and as
  // good as they have to be (least_hex), or as they were.
  void raise(double goal, int rounds);
  // The same for vertices whose cells are good enough, but not as good as `goal`: a poor cell rises only where those
  // around it yield, and they can only where they are better than they have to be. Ends when no cell of the gap is
  // below `enough`, the floors hold, and the cost has not risen. False if that does not come about, or if the second
  // round or a later one does not raise the least quality.
  bool raise_with_neighbours(double goal, double enough, int rounds);

  // Moves each of the first `most` vertices in turn by the one of a few steps along the axes after which the cost is
  // least. The floors, which have to hold before, hold. Faces have no gradient worth the name, because three cells and
  // a face change with each vertex. Ends after `rounds` rounds, or when nothing moves. Returns how much the cost falls.
  double lower_cost(int rounds, std::size_t most);

  // The volume of the chosen hexes at the moving vertices.
  double hex_volume() const;
  // The least quality among the cells that are not chosen.
  double least() const;
  // The length of the shortest edge of all cells.
  double shortest_edge() const;
  // False if a cell is not valid, or worse than its floor: that of the patch (a chosen hex: least_hex), or less if it
  // was.
  bool keeps_floors() const;
  // The cost of the gap's cells and faces after the change.
  double cost();
  // Whether that is no more than `most`. Faces are looked at only where the cells alone cost less.
  bool costs_at_most(double most);
  // The cost of the gap's cells and faces before it.
  double cost_before() const;

  // Makes the change and the moves.
  void carry_out(GapMesh& gap, const Replacement& replacement) const;

 private:
  using Local = std::int32_t;  // the place of a vertex in vertices_

  struct Cell {
    CellKind kind = CellKind::tet;
    bool is_kept = false;
    std::int32_t region = 0;
    double floor = 0;  // of its quality
    std::array<Local, 8> corners{};

    std::span<const Local> vertices() const {
      return std::span(corners).first(static_cast<std::size_t>(corner_count(kind)));
    }
  };

  Local local_of(Vertex v) const;
  void add(Cell cell, std::span<const Vertex> corners);
  double quality(const Cell& cell) const;
  bool is_good(const Cell& cell) const;
  void look_around(std::size_t i);
  bool improve(std::size_t i, double goal, double rise);
  double shortest_edge_at(std::size_t i) const;
  FacesOf faces_of(const Cell& cell) const;
  std::vector<FacesOf> faces_of_all() const;
  double cost_of_cells() const;
  double cost_at(std::size_t i, const FaceGraph& graph, std::vector<FacesOf>& faces) const;
  bool keeps_floors_at(std::size_t i) const;
  double step(std::size_t i, const FaceGraph& graph, std::vector<FacesOf>& faces);

  const GapMesh& gap_;
  double floor_;
  std::vector<Vertex> vertices_;  // ascending
  std::vector<Vec3> points_;
  std::vector<Cell> cells_;
  std::vector<GapIndex> before_;  // cells of the gap at the moving vertices, before the change
  std::vector<Local> fixed_;      // those of `moving_` that stay where they were placed
  bool changes_chosen_ = false;   // so that some of them may be below their floors at first
  std::vector<KeptIndex> kept_;   // chosen cells at the moving vertices and at those that merge
  std::vector<Local> moving_;
  std::vector<std::vector<std::size_t>> at_;  // by place in moving_: those of `cells_`
  shape::PointStar star_;
  std::optional<FaceGraph> graph_;  // of the cells, for cost(), when that has been asked for since take()
};

// Moves one vertex as Patch::lower_cost() does. False if no step lowers the cost.
bool step_to_lower_cost(GapMesh& gap, Patch& patch, Vertex v);

}  // namespace hexpipe::assemble::gap
