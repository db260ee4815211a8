// A hex between two facets of the boundary has neighbours in two directions alone: its determinant is next to 0. Halved
// at mid height, each half has a neighbour in the third one, too.

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "common/mesh/facet_key.hpp"
#include "common/mesh/vertex_items.hpp"
#include "formats/polyhedra/local_changes.hpp"
#include "formats/polyhedra/mend_polyhedra.hpp"

namespace hexpipe::polyhedra {
namespace {

// How far the middle of an edge moves, by the edge's length: enough to count as an angle, and too little to matter.
constexpr double bend = 1e-3;

// A direction of a cell: the edges along it, from one of two opposite faces to the other.
struct Direction {
  std::array<LocalEdge, 4> edges;
  std::size_t count;
};
constexpr std::array<Direction, 3> hex_directions{{{{{{0, 4}, {1, 5}, {2, 6}, {3, 7}}}, 4},
                                                   {{{{0, 1}, {3, 2}, {7, 6}, {4, 5}}}, 4},
                                                   {{{{0, 3}, {4, 7}, {5, 6}, {1, 2}}}, 4}}};
constexpr std::array<Direction, 1> prism_directions{{{{{{0, 3}, {1, 4}, {2, 5}, {0, 0}}}, 3}}};

std::span<const Direction> directions_of(CellKind kind) {
  if (kind == CellKind::hex) return hex_directions;
  return prism_directions;
}

// A cell that is to be halved: its corners at the lower end of the edges, in the order of the edges, and at the upper.
struct Column {
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
    if (columns_.empty()) return 0;
    halve_edges();
    halve_cells();
    return static_cast<std::int64_t>(columns_.size());
  }

 private:
  struct Sheet {
    std::vector<std::pair<std::int32_t, std::uint8_t>> cells;  // in cells_, with their directions
    std::vector<std::int32_t> touched;                         // prisms with such an edge in a triangle
    bool is_simple = true;                                     // it passes no cell twice
  };

  void choose_sheets(const std::vector<std::int32_t>& refused) {
    std::vector<std::int32_t> number_of(mesh_.cell_count(), no_index);
    for (std::size_t i = 0; i < cells_.size(); ++i) number_of[cells_[i].cell] = static_cast<std::int32_t>(i);
    at_vertices_ = VertexItems(mesh_.mesh().points.size(), [&](auto&& visit) {
      for (std::size_t i = 0; i < cells_.size(); ++i)
        for (std::size_t k = 0; k < corner_count_of(cells_[i]); ++k)
          visit(cells_[i].corners[k], static_cast<std::int32_t>(i));
    });
    column_of_.assign(mesh_.cell_count(), no_index);
    std::vector<std::uint8_t> is_taken(cells_.size());
    for (const std::int32_t cell : refused) {
      const std::int32_t number = number_of[cell];
      if (number == no_index || (mesh_.refusals_of_cell(cell) & determinant) == 0) continue;
      const auto directions = directions_of(cells_[number].kind);
      for (std::size_t d = 0; d < directions.size(); ++d) {
        if (column_of_[cell] != no_index || !is_between_facets(cells_[number], directions[d])) continue;
        const Sheet sheet = sheet_of(number, d);
        const auto free = [&](std::int32_t i) { return is_taken[i] == 0; };
        if (!sheet.is_simple || !std::ranges::all_of(sheet.touched, free) ||
            !std::ranges::all_of(sheet.cells, [&](const auto& at) { return free(at.first); }))
          continue;
        for (const std::int32_t i : sheet.touched) is_taken[i] = 1;
        for (const auto& [i, direction] : sheet.cells) is_taken[i] = 1, add_column(i, direction);
      }
    }
  }

  static std::size_t corner_count_of(const LayerCell& at) { return at.kind == CellKind::hex ? 8 : 6; }

  void add_column(std::int32_t number, std::size_t d) {
    const LayerCell& at = cells_[number];
    const Direction& direction = directions_of(at.kind)[d];
    Column column{at.cell, {}, {}};
    for (std::size_t i = 0; i < direction.count; ++i) {
      column.low.push_back(at.corners[direction.edges[i][0]]);
      column.high.push_back(at.corners[direction.edges[i][1]]);
    }
    column_of_[at.cell] = static_cast<std::int32_t>(columns_.size());
    columns_.push_back(std::move(column));
    numbers_.push_back(static_cast<std::size_t>(number));
  }

  // Hexes and prisms that are passed when the edges of a cell along a direction are halved: edges that are opposite in
  // a quad of a hex, or go along a prism, are halved together.
  Sheet sheet_of(std::int32_t start, std::size_t direction) const {
    Sheet sheet;
    std::map<std::int32_t, std::uint8_t> passed{{start, static_cast<std::uint8_t>(direction)}};
    std::set<std::int32_t> touched;
    KeySet<2> seen;
    std::vector<std::int32_t> next{start};
    while (!next.empty()) {
      const std::int32_t number = next.back();
      next.pop_back();
      const LayerCell& at = cells_[number];
      const Direction& along = directions_of(at.kind)[passed.at(number)];
      for (std::size_t i = 0; i < along.count; ++i) {
        const auto key = edge_key(at.corners[along.edges[i][0]], at.corners[along.edges[i][1]]);
        if (!seen.insert(key).second) continue;
        for (const std::int32_t other : at_vertices_.at(key[0])) {
          const auto place = place_of_edge(cells_[other], key);
          if (place == Place::outside) continue;
          if (place == Place::in_triangle) {
            touched.insert(other);
            continue;
          }
          const auto [found, is_new] = passed.try_emplace(other, static_cast<std::uint8_t>(place));
          if (is_new) next.push_back(other);
          if (found->second != static_cast<std::uint8_t>(place)) sheet.is_simple = false;
        }
      }
    }
    for (const std::int32_t number : touched)
      if (passed.contains(number)) sheet.is_simple = false;
    sheet.cells.assign(passed.begin(), passed.end());
    sheet.touched.assign(touched.begin(), touched.end());
    return sheet;
  }

  // An edge's direction in a cell.
  enum class Place : std::uint8_t { outside = 255, in_triangle = 254 };
  static Place place_of_edge(const LayerCell& at, const VertexKey<2>& key) {
    const auto directions = directions_of(at.kind);
    for (std::size_t d = 0; d < directions.size(); ++d)
      for (std::size_t i = 0; i < directions[d].count; ++i)
        if (edge_key(at.corners[directions[d].edges[i][0]], at.corners[directions[d].edges[i][1]]) == key)
          return static_cast<Place>(d);
    const auto corners = std::span(at.corners).first(corner_count_of(at));
    const bool both =
        std::ranges::find(corners, key[0]) != corners.end() && std::ranges::find(corners, key[1]) != corners.end();
    if (!both || at.kind == CellKind::hex) return Place::outside;
    for (const auto& edge : PrismTopology::edges)
      if (edge_key(at.corners[edge[0]], at.corners[edge[1]]) == key) return Place::in_triangle;
    return Place::outside;
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
          for (std::size_t i = 0; i < direction.count; ++i) found += v == at.corners[direction.edges[i][end]] ? 1 : 0;
        ends += found == direction.count && face.count == static_cast<std::int32_t>(found) ? 1 : 0;
      }
    }
    return ends == 2;
  }

  const Column* column_of(std::int32_t cell) const {
    if (static_cast<std::size_t>(cell) >= column_of_.size() || column_of_[cell] == no_index) return nullptr;
    return &columns_[static_cast<std::size_t>(column_of_[cell])];
  }

  // A side of a column whose other cell stays whole: its normal, towards that cell, the edges that it halves, and how
  // far their middles have to move together.
  struct OpenSide {
    std::int32_t face;
    Vec3 normal;
    std::array<VertexKey<2>, 2> edges;
    double goal = 1;
  };

  struct Middle {
    Vec3 move{};                // by the length of its edge, in thousandths
    std::vector<Vec3> along{};  // normals of the boundary, which it does not leave
    Vertex vertex = no_index;
  };

  void halve_edges() {
    for (const Column& column : columns_)
      for (std::size_t i = 0; i < column.low.size(); ++i) middles_.try_emplace(edge_key(column.low[i], column.high[i]));
    is_end_.assign(mesh_.mesh().points.size(), 0);
    for (const auto& [key, middle] : middles_)
      for (const Vertex v : key) is_end_[v] = 1;
    std::vector<OpenSide> sides;
    for (std::size_t i = 0; i < mesh_.mesh().faces.size(); ++i) note_side(static_cast<std::int32_t>(i), sides);
    // Warped sides need more.
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
    for (std::size_t i = 0; i < corners.size(); ++i) {
      halves[half].push_back(mesh_.mesh().points[corners[i]]);
      const auto key = edge_key(corners[i], corners[(i + 1) % corners.size()]);
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

  void note_side(std::int32_t number, std::vector<OpenSide>& sides) {
    const PolyhedralMesh::Face& face = mesh_.mesh().faces[number];
    if (face.owner == no_index) return;
    std::vector<VertexKey<2>> edges;
    for_each_halved(face, [&](const VertexKey<2>& key) { edges.push_back(key); });
    if (edges.empty()) return;
    const Vec3 normal = unit(mesh_.shape(number).area);
    if (!face.is_inner()) {
      for (const auto& key : edges) middles_.at(key).along.push_back(normal);
      return;
    }
    const Column *const one = column_of(face.owner), *const two = column_of(face.neighbour);
    if ((one == nullptr) == (two == nullptr)) return;
    const Column& column = one != nullptr ? *one : *two;
    std::erase_if(edges, [&](const VertexKey<2>& key) { return !is_along(column, key[0], key[1]); });
    if (edges.size() == 2) sides.push_back({number, one != nullptr ? normal : -normal, {edges[0], edges[1]}});
  }

  // Moves the middles so that each open side bends into its column: its two middles together by its goal. A side that
  // lacks something moves both by half of that, again and again.
  void bend_sides(const std::vector<OpenSide>& sides) {
    constexpr int most_rounds = 200;
    constexpr double most = 100;
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

  // visit(key) for the edges of a face that are halved.
  template <class Visit>
  void for_each_halved(const PolyhedralMesh::Face& face, Visit&& visit) const {
    const auto corners = mesh_.mesh().corners_of(face);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vertex a = corners[i], b = corners[(i + 1) % corners.size()];
      if (is_end_[a] == 0 || is_end_[b] == 0) continue;
      if (const auto key = edge_key(a, b); middles_.contains(key)) visit(key);
    }
  }

  void halve_cells() {
    for (const Column& column : columns_) upper_.push_back(mesh_.add_cell_after(column.cell));
    const std::size_t count = mesh_.mesh().faces.size();
    for (std::size_t i = 0; i < count; ++i) halve_face(static_cast<std::int32_t>(i));
    for (std::size_t i = 0; i < columns_.size(); ++i) add_middle(i);
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

  // The half of the column that the corner belongs to; the cell itself if it is not halved.
  std::int32_t half_of(std::int32_t cell, Vertex corner) const {
    const Column* const column = cell == no_index ? nullptr : column_of(cell);
    return column == nullptr || holds(column->low, corner) ? cell
                                                           : upper_[static_cast<std::size_t>(column - columns_.data())];
  }

  void halve_face(std::int32_t number) {
    const PolyhedralMesh::Face face = mesh_.mesh().faces[number];
    if (face.owner == no_index) return;
    const Column* const one = column_of(face.owner);
    const Column* const two = face.is_inner() ? column_of(face.neighbour) : nullptr;
    std::size_t halved = 0;
    for_each_halved(face, [&](const VertexKey<2>&) { ++halved; });
    if (halved == 0 && one == nullptr && two == nullptr) return;
    std::vector<Vertex> loop;
    std::vector<std::size_t> cuts;  // the middles of a column's own edges, by place in the loop
    const auto corners = mesh_.mesh().corners_of(face);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vertex a = corners[i], b = corners[(i + 1) % corners.size()];
      loop.push_back(a);
      const auto middle = middles_.find(edge_key(a, b));
      if (middle == middles_.end()) continue;
      if ((one != nullptr && is_along(*one, a, b)) || (two != nullptr && is_along(*two, a, b)))
        cuts.push_back(loop.size());
      loop.push_back(middle->second.vertex);
    }
    if (halved > 0)
      for (const std::int32_t cell : {face.owner, face.neighbour})
        if (cell != no_index && column_of(cell) == nullptr) whole_.insert(cell);
    const std::vector<Vertex> first = cuts.size() == 2 ? part_of_loop(loop, cuts[0], cuts[1]) : loop;
    const Vertex corner = first[cuts.size() == 2 ? 1 : 0];
    if (halved > 0) {
      mesh_.set_loop(number, first);
      mesh_.measure_face(number);
    }
    const std::int32_t owner = half_of(face.owner, corner), neighbour = half_of(face.neighbour, corner);
    mesh_.set_sides(number, owner, neighbour);
    if (one != nullptr) more_faces_[owner].push_back(number);
    if (two != nullptr) more_faces_[neighbour].push_back(number);
    if (cuts.size() != 2) return;
    const std::vector<Vertex> second = part_of_loop(loop, cuts[1], cuts[0]);
    const std::int32_t owner_of_second = half_of(face.owner, second[1]),
                       neighbour_of_second = half_of(face.neighbour, second[1]);
    const std::int32_t other = mesh_.add_face(second, owner_of_second, neighbour_of_second, face.surface, face.flipped);
    mesh_.measure_face(other);
    more_faces_[owner_of_second].push_back(other);
    if (face.is_inner()) more_faces_[neighbour_of_second].push_back(other);
  }

  static bool is_along(const Column& column, Vertex a, Vertex b) {
    for (std::size_t i = 0; i < column.low.size(); ++i)
      if ((column.low[i] == a && column.high[i] == b) || (column.low[i] == b && column.high[i] == a)) return true;
    return false;
  }

  // The face between the two halves, and their shapes and corners.
  void add_middle(std::size_t number) {
    const Column& column = columns_[number];
    std::vector<Vertex> loop;
    for (std::size_t i = 0; i < column.low.size(); ++i)
      loop.push_back(middles_.at(edge_key(column.low[i], column.high[i])).vertex);
    const std::int32_t lower = column.cell, upper = upper_[number];
    // From the lower half to the upper: counter-clockwise as seen from there.
    const std::int32_t face = mesh_.add_face(loop, lower, upper, no_index, false);
    mesh_.measure_face(face);
    const Vec3 up = mesh_.mesh().points[column.high[0]] - mesh_.mesh().points[column.low[0]];
    if (dot(mesh_.shape(face).area, up) < 0) mesh_.set_sides(face, upper, lower);
    more_faces_[lower].push_back(face), more_faces_[upper].push_back(face);
    for (const std::int32_t cell : {lower, upper}) {
      mesh_.set_faces(cell, more_faces_[cell]);
      mesh_.measure_cell(cell);
    }
    LayerCell &at = cells_[numbers_[number]], above = at;
    above.cell = upper;
    for (std::size_t i = 0; i < column.low.size(); ++i)
      for (std::size_t k = 0; k < 8; ++k) {
        if (above.corners[k] == column.low[i]) above.corners[k] = loop[i];
        if (at.corners[k] == column.high[i]) at.corners[k] = loop[i];
      }
    cells_.push_back(above);
  }

  MeasuredMesh& mesh_;
  std::vector<LayerCell>& cells_;
  VertexItems at_vertices_;  // cells_
  std::vector<Column> columns_;
  std::vector<std::size_t> numbers_;        // of the columns in cells_
  std::vector<std::int32_t> column_of_;     // by cell
  std::vector<std::int32_t> upper_;         // the upper half of each column
  std::map<VertexKey<2>, Middle> middles_;  // of halved edges
  std::vector<std::uint8_t> is_end_;        // by vertex
  std::map<std::int32_t, std::vector<std::int32_t>> more_faces_;
  std::set<std::int32_t> whole_;  // cells beside columns
};

}  // namespace

std::int64_t split_single_layers(MeasuredMesh& mesh, std::vector<LayerCell> cells,
                                 const MeasuredMesh::Refused& refused) {
  // A bar of one cell across needs two rounds, and sheets that cross a round each.
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
