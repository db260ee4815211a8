// A hex between two facets of the boundary has neighbours in two directions alone, so its determinant is nearly 0. Cut
// at mid height, each half has a neighbour in the third direction, too: the other half.
//
// The edges along that direction get a vertex in the middle. All hexes and prisms around such an edge are halved as
// well, then those around their edges in the same direction, and so on: together they are a sheet. It ends at the
// boundary and at cells that have no opposite edge, tets for example. These stay whole, and two faces of theirs come
// where one was.

#include <algorithm>
#include <map>
#include <ranges>
#include <set>
#include <span>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/vertex_items.hpp"
#include "formats/polyhedra/local_changes.hpp"
#include "formats/polyhedra/mend_polyhedra.hpp"

namespace hexpipe::polyhedra {
namespace {

// How far the middle of an edge moves at the end of a sheet, by the edge's length: enough to count as an angle, and too
// little to matter.
constexpr double bend = 1e-3;

// A direction of a hex or prism: the edges that lead from a face to the opposite one.
struct Direction {
  std::array<LocalEdge, 4> edges;
  std::size_t count;  // 4, or 3 from triangle to triangle

  std::span<const LocalEdge> all() const { return std::span(edges).first(count); }
};

// The direction that begins at a face with corner 0, with the edges in the order of its corners as seen from inside,
// from corner 0 on.
template <class Topology, std::size_t N>
constexpr Direction direction_from(const std::array<std::uint8_t, N>& face) {
  const auto is_in_face = [&](std::uint8_t corner) { return std::ranges::find(face, corner) != face.end(); };
  const auto start = static_cast<std::size_t>(std::ranges::find(face, std::uint8_t{0}) - face.begin());
  Direction direction{{}, N};
  for (std::size_t i = 0; i < N; ++i) {
    const std::uint8_t corner = face[(start + N - i) % N];
    for (const LocalEdge& edge : Topology::edges)
      for (const std::size_t end : {0, 1})
        if (edge[end] == corner && !is_in_face(edge[1 - end])) direction.edges[i] = {corner, edge[1 - end]};
  }
  return direction;
}

constexpr std::array hex_directions{direction_from<HexTopology>(HexTopology::quads[0]),
                                    direction_from<HexTopology>(HexTopology::quads[5]),
                                    direction_from<HexTopology>(HexTopology::quads[2])};
constexpr std::array prism_directions{direction_from<PrismTopology>(PrismTopology::triangles[0])};

std::span<const Direction> directions_of(CellKind kind) {
  if (kind == CellKind::hex) return hex_directions;
  return prism_directions;
}

// A cell that is to be halved: the corners at the lower and at the upper ends of its edges, in the order of the edges.
struct HalvedCell {
  std::int32_t cell;
  std::vector<Vertex> low, high;
};

bool holds(const std::vector<Vertex>& list, Vertex v) {
  return std::ranges::find(list, v) != list.end();
}

class Splitter {
 public:
  Splitter(MeasuredMesh& mesh, std::vector<LayerCell>& cells) : mesh_(mesh), cells_(cells) {}

  // Returns how many cells were halved.
  std::int64_t split(const std::vector<std::int32_t>& refused) {
    choose_sheets(refused);
    if (halved_.empty()) return 0;
    halve_edges();
    halve_cells();
    return static_cast<std::int64_t>(halved_.size());
  }

 private:
  // Cells are numbers in cells_.
  struct Sheet {
    std::map<std::int32_t, int> directions;  // of the cells that are halved
    std::set<std::int32_t> touched;          // prisms with a halved edge in a triangle, which stay whole
    bool is_simple = true;                   // it passes each cell once, and touches none that it passes
  };

  // The sheets of the refused cells, unless they are not simple or meet a sheet of this round.
  void choose_sheets(const std::vector<std::int32_t>& refused) {
    std::vector<std::int32_t> number_of(mesh_.cell_count(), no_index);
    for (std::size_t i = 0; i < cells_.size(); ++i) number_of[cells_[i].cell] = static_cast<std::int32_t>(i);
    at_vertices_ = VertexItems(mesh_.mesh().points.size(), [&](auto&& visit) {
      for (std::size_t i = 0; i < cells_.size(); ++i)
        for (const Vertex v : corners_of(cells_[i])) visit(v, static_cast<std::int32_t>(i));
    });
    halved_of_.assign(mesh_.cell_count(), no_index);
    std::vector<std::uint8_t> is_taken(cells_.size());
    for (const std::int32_t cell : refused) {
      const std::int32_t number = number_of[cell];
      if (number == no_index || (mesh_.refusals_of_cell(cell) & determinant) == 0) continue;
      const auto directions = directions_of(cells_[number].kind);
      for (std::size_t d = 0; d < directions.size(); ++d) {
        if (halved_of_[cell] != no_index || !is_between_facets(cells_[number], directions[d])) continue;
        const Sheet sheet = sheet_of(number, static_cast<int>(d));
        const auto is_free = [&](std::int32_t i) { return is_taken[i] == 0; };
        if (!sheet.is_simple || !std::ranges::all_of(sheet.touched, is_free) ||
            !std::ranges::all_of(sheet.directions | std::views::keys, is_free))
          continue;
        for (const std::int32_t i : sheet.touched) is_taken[i] = 1;
        for (const auto& [i, direction] : sheet.directions) is_taken[i] = 1, add_halved(i, direction);
      }
    }
  }

  static std::span<const Vertex> corners_of(const LayerCell& at) {
    return std::span(at.corners).first(static_cast<std::size_t>(corner_count(at.kind)));
  }

  void add_halved(std::int32_t number, int d) {
    const LayerCell& at = cells_[number];
    HalvedCell halved{at.cell, {}, {}};
    for (const LocalEdge& edge : directions_of(at.kind)[d].all()) {
      halved.low.push_back(at.corners[edge[0]]);
      halved.high.push_back(at.corners[edge[1]]);
    }
    halved_of_[at.cell] = static_cast<std::int32_t>(halved_.size());
    halved_.push_back(std::move(halved));
    numbers_.push_back(static_cast<std::size_t>(number));
  }

  // The sheet that a cell is halved with in this direction.
  Sheet sheet_of(std::int32_t start, int direction) const {
    Sheet sheet;
    sheet.directions.emplace(start, direction);
    KeySet<2> seen;
    std::vector<std::int32_t> next{start};
    while (!next.empty()) {
      const std::int32_t number = next.back();
      next.pop_back();
      const LayerCell& at = cells_[number];
      for (const LocalEdge& edge : directions_of(at.kind)[sheet.directions.at(number)].all()) {
        const auto key = edge_key(at.corners[edge[0]], at.corners[edge[1]]);
        if (!seen.insert(key).second) continue;
        for (const std::int32_t other : at_vertices_.at(key[0])) {
          const int found = direction_of_edge(cells_[other], key);
          if (found == not_an_edge) continue;
          if (found == in_triangle) {
            sheet.touched.insert(other);
            continue;
          }
          const auto [at_other, is_new] = sheet.directions.try_emplace(other, found);
          if (is_new) next.push_back(other);
          if (at_other->second != found) sheet.is_simple = false;
        }
      }
    }
    for (const std::int32_t number : sheet.touched)
      if (sheet.directions.contains(number)) sheet.is_simple = false;
    return sheet;
  }

  // The direction of a cell that an edge belongs to, or one of the numbers below 0.
  static constexpr int not_an_edge = -1, in_triangle = -2;
  static int direction_of_edge(const LayerCell& at, const VertexKey<2>& key) {
    const auto is_key = [&](const LocalEdge& edge) {
      return edge_key(at.corners[edge[0]], at.corners[edge[1]]) == key;
    };
    const auto directions = directions_of(at.kind);
    for (std::size_t d = 0; d < directions.size(); ++d)
      if (std::ranges::any_of(directions[d].all(), is_key)) return static_cast<int>(d);
    // Each edge of a hex belongs to a direction.
    if (at.kind == CellKind::hex) return not_an_edge;
    return std::ranges::any_of(PrismTopology::edges, is_key) ? in_triangle : not_an_edge;
  }

  // Whether the faces at both ends of the direction are on the boundary.
  bool is_between_facets(const LayerCell& at, const Direction& direction) const {
    int ends = 0;
    for (const std::int32_t number : mesh_.faces_of(at.cell)) {
      const PolyhedralMesh::Face& face = mesh_.mesh().faces[number];
      if (face.is_inner()) continue;
      for (const std::size_t end : {0, 1}) {
        std::size_t found = 0;
        for (const Vertex v : mesh_.mesh().corners_of(face))
          for (const LocalEdge& edge : direction.all()) found += v == at.corners[edge[end]] ? 1 : 0;
        ends += found == direction.count && face.count == static_cast<std::int32_t>(found) ? 1 : 0;
      }
    }
    return ends == 2;
  }

  // nullptr: the cell stays whole.
  const HalvedCell* halved(std::int32_t cell) const {
    if (static_cast<std::size_t>(cell) >= halved_of_.size() || halved_of_[cell] == no_index) return nullptr;
    return &halved_[static_cast<std::size_t>(halved_of_[cell])];
  }

  // A side of a halved cell whose other cell stays whole.
  struct OpenSide {
    std::int32_t face;
    Vec3 normal;                        // towards the cell that stays whole
    std::array<VertexKey<2>, 2> edges;  // those of the side that are halved
    double goal = 1;                    // how far both middles together have to move against the normal, by `bend`
  };

  // The middle of a halved edge.
  struct Middle {
    Vec3 move{};                // by the length of its edge times `bend`
    std::vector<Vec3> along{};  // normals of the boundary, which it does not leave
    Vertex vertex = no_index;
  };

  // Adds the middles of all edges, moved so that open sides bend.
  void halve_edges() {
    for (const HalvedCell& cell : halved_)
      for (std::size_t i = 0; i < cell.low.size(); ++i) middles_.try_emplace(edge_key(cell.low[i], cell.high[i]));
    is_end_.assign(mesh_.mesh().points.size(), 0);
    for (const auto& [key, middle] : middles_)
      for (const Vertex v : key) is_end_[v] = 1;
    std::vector<OpenSide> sides;
    for (std::size_t i = 0; i < mesh_.mesh().faces.size(); ++i) note_side(static_cast<std::int32_t>(i), sides);
    // Warped sides need more than flat ones.
    constexpr int most_doublings = 7;
    for (int i = 0; i <= most_doublings; ++i) {
      bend_sides(sides);
      bool all = true;
      for (OpenSide& side : sides) {
        if (is_bent(side)) continue;
        side.goal *= 2;
        all = false;
      }
      if (all) break;
    }
    for (auto& [key, middle] : middles_) middle.vertex = mesh_.add_point(place_of(key, middle));
  }

  Vec3 place_of(const VertexKey<2>& key, const Middle& middle) const {
    const Vec3 &a = mesh_.mesh().points[key[0]], &b = mesh_.mesh().points[key[1]];
    return (a + b) * 0.5 + middle.move * (bend * norm(b - a));
  }

  // Whether the halves of the side are clearly convex for the cell that stays whole.
  bool is_bent(const OpenSide& side) const {
    constexpr double clearly = 1e-5;
    const auto corners = mesh_.mesh().corners_of(mesh_.mesh().faces[side.face]);
    std::array<std::vector<Vec3>, 2> halves;
    std::size_t half = 0;
    for (const auto& [a, b] : edges_of(corners)) {
      halves[half].push_back(mesh_.mesh().points[a]);
      const auto key = edge_key(a, b);
      if (key != side.edges[0] && key != side.edges[1]) continue;
      const Vec3 place = place_of(key, middles_.at(key));
      halves[half].push_back(place);
      half = 1 - half;
      halves[half].push_back(place);
    }
    const FaceShape one = face_shape(halves[0]), two = face_shape(halves[1]);
    // Outward from the cell that stays whole.
    const double sign = dot(mesh_.shape(side.face).area, side.normal) > 0 ? -1 : 1;
    const Vec3 line = unit(two.centre - one.centre);
    return dot(line, unit(one.area)) * sign < -clearly && dot(line, unit(two.area)) * sign > clearly;
  }

  // What a face says of the middles on it: a facet of the boundary, where they stay, or an open side.
  void note_side(std::int32_t number, std::vector<OpenSide>& sides) {
    const PolyhedralMesh::Face& face = mesh_.mesh().faces[number];
    if (face.owner == no_index) return;
    std::vector<VertexKey<2>> edges;
    for (const auto& [a, b] : edges_of(mesh_.mesh().corners_of(face)))
      if (middle_of(a, b) != nullptr) edges.push_back(edge_key(a, b));
    if (edges.empty()) return;
    const Vec3 normal = unit(mesh_.shape(number).area);
    if (!face.is_inner()) {
      for (const auto& key : edges) middles_.at(key).along.push_back(normal);
      return;
    }
    const HalvedCell *const one = halved(face.owner), *const two = halved(face.neighbour);
    if ((one == nullptr) == (two == nullptr)) return;
    const HalvedCell& cell = one != nullptr ? *one : *two;
    std::erase_if(edges, [&](const VertexKey<2>& key) { return !is_along(cell, key[0], key[1]); });
    if (edges.size() == 2) sides.push_back({number, one != nullptr ? normal : -normal, {edges[0], edges[1]}});
  }

  // Moves the middles so that each open side bends into its halved cell, its two middles together by its goal. A side
  // that lacks something moves both by half of that. This is repeated, for a middle may be in several sides.
  void bend_sides(const std::vector<OpenSide>& sides) {
    constexpr int most_rounds = 200;
    constexpr double most = 100;  // a tenth of the edge
    bool all = false;
    for (int round = 0; round < most_rounds && !all; ++round) {
      all = true;
      for (const OpenSide& side : sides) {
        Middle &one = middles_.at(side.edges[0]), &two = middles_.at(side.edges[1]);
        const double lack = side.goal + dot(one.move + two.move, side.normal);
        if (lack <= 1e-3) continue;
        all = false;
        for (Middle* const middle : {&one, &two}) {
          middle->move -= side.normal * (lack / 2);
          for (const Vec3& normal : middle->along) middle->move -= normal * dot(middle->move, normal);
          if (const double length = norm(middle->move); length > most) middle->move *= most / length;
        }
      }
    }
  }

  // The middle of an edge; nullptr: it is not halved.
  const Middle* middle_of(Vertex a, Vertex b) const {
    if (is_end_[a] == 0 || is_end_[b] == 0) return nullptr;
    const auto found = middles_.find(edge_key(a, b));
    return found == middles_.end() ? nullptr : &found->second;
  }

  void halve_cells() {
    for (const HalvedCell& cell : halved_) upper_.push_back(mesh_.add_cell_after(cell.cell));
    const std::size_t count = mesh_.mesh().faces.size();
    for (std::size_t i = 0; i < count; ++i) halve_face(static_cast<std::int32_t>(i));
    for (std::size_t i = 0; i < halved_.size(); ++i) add_middle_face(i);
    for (const std::int32_t cell : whole_) {
      std::vector<std::int32_t> faces(mesh_.faces_of(cell).begin(), mesh_.faces_of(cell).end());
      if (const auto more = more_faces_.find(cell); more != more_faces_.end())
        faces.insert(faces.end(), more->second.begin(), more->second.end());
      mesh_.set_faces(cell, faces);
      mesh_.set_hex(cell, false);
      mesh_.measure_cell(cell);
    }
    std::erase_if(cells_, [&](const LayerCell& at) { return whole_.contains(at.cell); });
  }

  // The half of a cell that the corner belongs to; the cell itself if it stays whole.
  std::int32_t half_of(std::int32_t cell, Vertex corner) const {
    const HalvedCell* const at = cell == no_index ? nullptr : halved(cell);
    return at == nullptr || holds(at->low, corner) ? cell : upper_[static_cast<std::size_t>(at - halved_.data())];
  }

  // A face's loop with the middles of its edges, and where in it those lie at which the face is cut in two.
  struct HalvedLoop {
    std::vector<Vertex> loop;
    std::vector<std::size_t> cuts;  // two or none
    bool has_middles = false;
  };
  HalvedLoop loop_with_middles(const PolyhedralMesh::Face& face) const {
    const HalvedCell* const one = halved(face.owner);
    const HalvedCell* const two = face.is_inner() ? halved(face.neighbour) : nullptr;
    HalvedLoop result;
    for (const auto& [a, b] : edges_of(mesh_.mesh().corners_of(face))) {
      result.loop.push_back(a);
      const Middle* const middle = middle_of(a, b);
      if (middle == nullptr) continue;
      // An edge of a face between halves may be halved by a third cell, and does not cut the face.
      if ((one != nullptr && is_along(*one, a, b)) || (two != nullptr && is_along(*two, a, b)))
        result.cuts.push_back(result.loop.size());
      result.loop.push_back(middle->vertex);
      result.has_middles = true;
    }
    return result;
  }

  // Gives the face the middles as corners or cuts it in two, and gives its parts to the halves of its cells.
  void halve_face(std::int32_t number) {
    const PolyhedralMesh::Face face = mesh_.mesh().faces[number];
    if (face.owner == no_index) return;
    const HalvedLoop with_middles = loop_with_middles(face);
    const bool is_of_halved = halved(face.owner) != nullptr || (face.is_inner() && halved(face.neighbour) != nullptr);
    if (!with_middles.has_middles && !is_of_halved) return;
    if (with_middles.has_middles)
      for (const std::int32_t cell : {face.owner, face.neighbour})
        if (cell != no_index && halved(cell) == nullptr) whole_.insert(cell);
    const std::vector<Vertex>& loop = with_middles.loop;
    if (with_middles.cuts.size() != 2) {
      if (with_middles.has_middles) {
        mesh_.set_loop(number, loop);
        mesh_.measure_face(number);
      }
      give_to_halves(number, face, loop[0], false);
      return;
    }
    // Both parts begin with a middle; their next corner is one of the face.
    const std::size_t one = with_middles.cuts[0], two = with_middles.cuts[1];
    const std::vector<Vertex> first = part_of_loop(loop, one, two), second = part_of_loop(loop, two, one);
    mesh_.set_loop(number, first);
    mesh_.measure_face(number);
    give_to_halves(number, face, first[1], false);
    const std::int32_t other = mesh_.add_face(second, face.owner, face.neighbour, face.surface, face.flipped);
    mesh_.measure_face(other);
    give_to_halves(other, face, second[1], true);
  }

  // The face's sides become the halves that have this corner of it. Halves get their list of faces anew; a cell that
  // stays whole has the face already, unless it is new.
  void give_to_halves(std::int32_t number, const PolyhedralMesh::Face& face, Vertex corner, bool is_new) {
    const std::int32_t owner = half_of(face.owner, corner), neighbour = half_of(face.neighbour, corner);
    mesh_.set_sides(number, owner, neighbour);
    if (is_new || halved(face.owner) != nullptr) more_faces_[owner].push_back(number);
    if (face.is_inner() && (is_new || halved(face.neighbour) != nullptr)) more_faces_[neighbour].push_back(number);
  }

  // Whether the edge is one of those that the cell is halved along.
  static bool is_along(const HalvedCell& cell, Vertex a, Vertex b) {
    for (std::size_t i = 0; i < cell.low.size(); ++i)
      if ((cell.low[i] == a && cell.high[i] == b) || (cell.low[i] == b && cell.high[i] == a)) return true;
    return false;
  }

  // Adds the face between the two halves of a cell, which then have all their faces, and notes the corners of both.
  void add_middle_face(std::size_t number) {
    const HalvedCell& cell = halved_[number];
    std::vector<Vertex> loop;
    for (std::size_t i = 0; i < cell.low.size(); ++i)
      loop.push_back(middles_.at(edge_key(cell.low[i], cell.high[i])).vertex);
    const std::int32_t lower = cell.cell, upper = upper_[number];
    // From the lower half to the upper: counter-clockwise as seen from there.
    const std::int32_t face = mesh_.add_face(loop, lower, upper, no_index, false);
    mesh_.measure_face(face);
    const Vec3 up = mesh_.mesh().points[cell.high[0]] - mesh_.mesh().points[cell.low[0]];
    if (dot(mesh_.shape(face).area, up) < 0) mesh_.set_sides(face, upper, lower);
    more_faces_[lower].push_back(face), more_faces_[upper].push_back(face);
    for (const std::int32_t half : {lower, upper}) {
      mesh_.set_faces(half, more_faces_[half]);
      mesh_.measure_cell(half);
    }
    LayerCell &at = cells_[numbers_[number]], above = at;
    above.cell = upper;
    for (std::size_t i = 0; i < cell.low.size(); ++i)
      for (std::size_t k = 0; k < 8; ++k) {
        if (above.corners[k] == cell.low[i]) above.corners[k] = loop[i];
        if (at.corners[k] == cell.high[i]) at.corners[k] = loop[i];
      }
    cells_.push_back(above);
  }

  MeasuredMesh& mesh_;
  std::vector<LayerCell>& cells_;
  VertexItems at_vertices_;                 // numbers in cells_
  std::vector<HalvedCell> halved_;          // of this round
  std::vector<std::size_t> numbers_;        // of halved_ in cells_
  std::vector<std::int32_t> halved_of_;     // by cell: its place in halved_; no_index: it stays whole
  std::vector<std::int32_t> upper_;         // by place in halved_: the cell that is the upper half
  std::map<VertexKey<2>, Middle> middles_;  // of halved edges
  std::vector<std::uint8_t> is_end_;        // by vertex: whether a halved edge ends there
  std::map<std::int32_t, std::vector<std::int32_t>> more_faces_;  // all faces of a half; new faces of a whole cell
  std::set<std::int32_t> whole_;                                  // cells that are not halved, but whose edges are
};

}  // namespace

std::int64_t split_single_layers(MeasuredMesh& mesh, std::vector<LayerCell> cells,
                                 const MeasuredMesh::Refused& refused) {
  // A bar of one cell across is halved in two directions, one a round; sheets that cross need a round each.
  constexpr int most_rounds = 4;
  std::int64_t count = 0;
  for (int round = 0; round < most_rounds; ++round) {
    const std::vector<std::int32_t> now = round == 0 ? refused.cells : mesh.refused_after(refused).cells;
    const std::int64_t halved = Splitter(mesh, cells).split(now);
    count += halved;
    if (halved == 0) break;
  }
  return count;
}

}  // namespace hexpipe::polyhedra
