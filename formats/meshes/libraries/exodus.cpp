// The module for Exodus II, by Sandia's library on NetCDF.

#include <exodusII.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "formats/meshes/element_nodes.hpp"
#include "formats/meshes/libraries/library_errors.hpp"
#include "formats/meshes/mesh_library.hpp"

namespace hexpipe::formats {
namespace {

// Sides as Exodus numbers them, outward; -1: a triangle.
using Side = std::array<int, 4>;
struct ExodusKind {
  std::uint8_t vtk;
  const char* type;             // that all readers know
  const char* of_second_order;  // before the number of nodes
  std::string_view prefix;      // of the types that readers meet
  int corners;
  std::vector<Side> sides;
};

const std::vector<ExodusKind>& exodus_kinds() {
  static const std::vector<ExodusKind> kinds{
      {12,
       "HEX8",
       "HEX",
       "HEX",
       8,
       {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}}},
      {13, "WEDGE", "WEDGE", "WEDGE", 6, {{0, 1, 4, 3}, {1, 2, 5, 4}, {0, 3, 5, 2}, {0, 2, 1, -1}, {3, 4, 5, -1}}},
      {14, "PYRAMID", "PYRAMID", "PYRA", 5, {{0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}, {0, 3, 2, 1}}},
      {10, "TETRA", "TETRA", "TET", 4, {{0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}, {0, 2, 1, -1}}},
      // Shells: surfaces, for us.
      {5, "TRI3", "TRI", "TRI", 3, {}},
      {9, "SHELL4", "SHELL", "SHELL", 4, {}},
      {9, "SHELL4", "SHELL", "QUAD", 4, {}},
  };
  return kinds;
}

const ExodusKind& kind_of(std::uint8_t vtk) {
  return *std::ranges::find(exodus_kinds(), vtk, &ExodusKind::vtk);
}

Side sorted(Side side) {
  std::ranges::sort(side);
  return side;
}

// The number of the side, from 1, that is a facet in our list of triangles or of quads.
int side_number(const CellSide& at, bool is_triangle) {
  Side facet{-1, -1, -1, -1};
  with_topology(at.kind, [&](auto topology) {
    using Topology = decltype(topology);
    if (is_triangle)
      std::ranges::copy(std::span(Topology::triangles)[at.facet], facet.begin());
    else
      std::ranges::copy(std::span(Topology::quads)[at.facet], facet.begin());
  });
  const auto& sides = kind_of(static_cast<std::uint8_t>(at.kind)).sides;
  return 1 + static_cast<int>(std::ranges::find(sides, sorted(facet), sorted) - sides.begin());
}

std::string reason_of_failure() {
  const char *message = nullptr, *function = nullptr;
  int code = 0;
  ex_get_err(&message, &function, &code);
  return code != 0 && code != EX_MSG && code != EX_BADPARAM ? nc_strerror(code) : message;
}

// Throw the reason of a call that failed.
void check(int result) {
  if (result < 0) fail(reason_of_failure());
}
void check_read(int result) {
  if (result < 0) fail("cannot read as Exodus II: " + reason_of_failure());
}

class ExodusFile {
 public:
  static ExodusFile create(const std::string& path, int mode) {
    int computed = sizeof(double), stored = sizeof(double);
    const int id = ex_create(path.c_str(), mode, &computed, &stored);
    check(id);
    return ExodusFile(id);
  }
  static ExodusFile open(const std::string& path) {
    int computed = sizeof(double), stored = 0;
    float version = 0;
    const int id = ex_open(path.c_str(), EX_READ, &computed, &stored, &version);
    check_read(id);
    return ExodusFile(id);
  }
  ~ExodusFile() {
    if (id_ >= 0) ex_close(id_);
  }
  ExodusFile(const ExodusFile&) = delete;
  ExodusFile& operator=(const ExodusFile&) = delete;

  int id() const { return id_; }
  void close() { check(ex_close(std::exchange(id_, -1))); }

 private:
  explicit ExodusFile(int id) : id_(id) {}

  int id_;
};

struct SideSet {
  std::string name;
  std::vector<int> elements, sides, nodes;
};

class ExodusWriter {
 public:
  ExodusWriter(const GroupedMesh& mesh, const std::string& path)
      : mesh_(mesh), file_(ExodusFile::create(path, EX_CLOBBER | model_for(mesh))), id_(file_.id()) {}

  void write() {
    number_elements();
    collect_sides();
    std::size_t longest = MAX_NAME_LENGTH;
    for (const ElementGroup& block : mesh_.cells) longest = std::max(longest, block.name.size());
    for (const auto& [number, set] : sets_) longest = std::max(longest, set.name.size());
    check(ex_set_max_name_length(id_, static_cast<int>(longest)));
    const auto set_count = static_cast<std::int64_t>(sets_.size());
    check(ex_put_init(id_, "hexpipe mesh", 3, static_cast<std::int64_t>(mesh_.points.size()),
                      static_cast<std::int64_t>(numbers_.size()), static_cast<std::int64_t>(mesh_.cells.size()),
                      set_count, set_count));
    // The header grows with each of these: before there are data behind it, which would have to move.
    declare_blocks();
    declare_sets();
    write_names();
    write_points();
    write_blocks();
    write_sets();
    file_.close();
  }

 private:
  // Classic NetCDF, which every reader has, holds arrays of 4 GiB; larger ones need HDF5.
  static int model_for(const GroupedMesh& mesh) {
    constexpr std::size_t most = 4294967292;
    std::size_t largest = mesh.points.size() * sizeof(double);
    for (const ElementGroup& block : mesh.cells)
      largest = std::max(largest, (block.corners.size() + block.nodes.size()) * sizeof(int));
    return largest > most ? EX_NETCDF4 : EX_LARGE_MODEL;
  }

  // Blocks have the numbers of their regions, but for the second and later kinds of one.
  void number_elements() {
    std::set<ex_entity_id> taken;
    for (const ElementGroup& block : mesh_.cells) taken.insert(block.number);
    std::set<ex_entity_id> used;
    ex_entity_id free_id = 1;
    for (const ElementGroup& block : mesh_.cells) {
      ex_entity_id id = block.number;
      if (!used.insert(id).second) {
        while (!taken.insert(free_id).second) ++free_id;
        id = free_id;
      }
      block_ids_.push_back(id);
      for (const std::int64_t place : block.places) {
        if (static_cast<std::size_t>(place) >= numbers_.size()) numbers_.resize(static_cast<std::size_t>(place) + 1);
        numbers_[static_cast<std::size_t>(place)] = static_cast<int>(element_places_.size()) + 1;
        element_places_.push_back(static_cast<int>(place) + 1);
      }
    }
  }

  void collect_sides() {
    for (const ElementGroup& group : mesh_.facets) {
      SideSet& set = sets_[group.number];
      set.name = group.name;
      const bool is_triangle = corners_of_kind(group.kind) == 3;
      for (const CellSide& side : group.sides) {
        set.elements.push_back(numbers_[static_cast<std::size_t>(side.cell)]);
        set.sides.push_back(side_number(side, is_triangle));
      }
      for (const Vertex v : group.corners) set.nodes.push_back(v + 1);
      for (const Vertex v : group.nodes) set.nodes.push_back(v + 1);
    }
    for (auto& [number, set] : sets_) {
      std::ranges::sort(set.nodes);
      set.nodes.erase(std::ranges::unique(set.nodes).begin(), set.nodes.end());
    }
  }

  void declare_blocks() {
    for (std::size_t i = 0; i < mesh_.cells.size(); ++i) {
      const ElementGroup& block = mesh_.cells[i];
      const ExodusKind& kind = kind_of(block.kind);
      const auto nodes = static_cast<std::int64_t>(order_of(block).size());
      const std::string type =
          mesh_.second_order ? std::string(kind.of_second_order) + std::to_string(nodes) : kind.type;
      check(ex_put_block(id_, EX_ELEM_BLOCK, block_ids_[i], type.c_str(), static_cast<std::int64_t>(block.size()),
                         nodes, 0, 0, 0));
    }
  }

  void declare_sets() {
    for (const auto& [number, set] : sets_) {
      check(ex_put_set_param(id_, EX_SIDE_SET, number, static_cast<std::int64_t>(set.sides.size()), 0));
      check(ex_put_set_param(id_, EX_NODE_SET, number, static_cast<std::int64_t>(set.nodes.size()), 0));
    }
  }

  void write_names() {
    for (std::size_t i = 0; i < mesh_.cells.size(); ++i)
      check(ex_put_name(id_, EX_ELEM_BLOCK, block_ids_[i], mesh_.cells[i].name.c_str()));
    for (const auto& [number, set] : sets_) {
      check(ex_put_name(id_, EX_SIDE_SET, number, set.name.c_str()));
      check(ex_put_name(id_, EX_NODE_SET, number, set.name.c_str()));
    }
  }

  void write_points() {
    std::array<std::vector<double>, 3> coordinates;
    for (const Vec3& p : mesh_.points) {
      coordinates[0].push_back(p.x);
      coordinates[1].push_back(p.y);
      coordinates[2].push_back(p.z);
    }
    check(ex_put_coord(id_, coordinates[0].data(), coordinates[1].data(), coordinates[2].data()));
    std::array<char, 2> x{"x"}, y{"y"}, z{"z"};
    std::array<char*, 3> names{x.data(), y.data(), z.data()};
    check(ex_put_coord_names(id_, names.data()));
  }

  std::vector<std::size_t> order_of(const ElementGroup& block) const {
    return node_order(exodus_nodes, block.kind, mesh_.second_order, mesh_.full);
  }

  void write_blocks() {
    std::vector<int> corners;
    for (std::size_t i = 0; i < mesh_.cells.size(); ++i) {
      corners.clear();
      const std::vector<std::size_t> order = order_of(mesh_.cells[i]);
      for (std::size_t e = 0; e < mesh_.cells[i].size(); ++e) list_nodes(mesh_.cells[i], e, order, corners);
      for (Vertex& v : corners) ++v;
      check(ex_put_conn(id_, EX_ELEM_BLOCK, block_ids_[i], corners.data(), nullptr, nullptr));
    }
    // Elements keep their numbers, though each block has its own together.
    if (!std::ranges::is_sorted(element_places_)) check(ex_put_id_map(id_, EX_ELEM_MAP, element_places_.data()));
  }

  void write_sets() {
    for (const auto& [number, set] : sets_) {
      check(ex_put_set(id_, EX_SIDE_SET, number, set.elements.data(), set.sides.data()));
      check(ex_put_set(id_, EX_NODE_SET, number, set.nodes.data(), nullptr));
    }
  }

  const GroupedMesh& mesh_;
  ExodusFile file_;
  int id_;
  std::vector<ex_entity_id> block_ids_;
  std::vector<int> numbers_;         // by place among the cells: the element, from 1
  std::vector<int> element_places_;  // by element: the place, from 1
  std::map<ex_entity_id, SideSet> sets_;
};

class ExodusReader {
 public:
  explicit ExodusReader(const std::string& path)
      : file_(ExodusFile::open(path)), id_(file_.id()), most_numbers_(most_numbers_in(path)) {}

  GroupedMesh read() {
    read_sizes();
    read_points();
    read_blocks();
    number_elements();
    read_side_sets();
    return std::move(mesh_);
  }

 private:
  struct Entity {
    ex_entity_id id;
    std::string name;
  };

  void read_sizes() {
    std::array<char, MAX_LINE_LENGTH + 1> title{};
    int dimensions = 0, points = 0, elements = 0, blocks = 0, node_sets = 0, side_sets = 0;
    check_read(ex_get_init(id_, title.data(), &dimensions, &points, &elements, &blocks, &node_sets, &side_sets));
    if (dimensions != 3) fail_expected("3 dimensions", dimensions);
    point_count_ = count(points, "points");
    element_count_ = count(elements, "elements");
    block_count_ = count(blocks, "element blocks");
    set_count_ = count(side_sets, "side sets");
  }

  // A file cannot hold more numbers than its size allows: before memory is taken for them.
  std::size_t count(std::int64_t found, const char* what) const {
    if (found < 0 || static_cast<std::uint64_t>(found) > most_numbers_)
      fail("expected as many " + std::string(what) + " as the file has room for, found " + std::to_string(found));
    return static_cast<std::size_t>(found);
  }

  void read_points() {
    std::array<std::vector<double>, 3> coordinates;
    for (auto& list : coordinates) list.resize(point_count_);
    if (point_count_ > 0)
      check_read(ex_get_coord(id_, coordinates[0].data(), coordinates[1].data(), coordinates[2].data()));
    mesh_.points.reserve(point_count_);
    for (std::size_t i = 0; i < point_count_; ++i)
      mesh_.points.push_back({coordinates[0][i], coordinates[1][i], coordinates[2][i]});
  }

  std::vector<Entity> entities(ex_entity_type type, std::size_t entity_count) {
    std::vector<int> ids(entity_count);
    if (entity_count > 0) check_read(ex_get_ids(id_, type, ids.data()));
    const std::int64_t longest = ex_inquire_int(id_, EX_INQ_DB_MAX_ALLOWED_NAME_LENGTH);
    check_read(ex_set_max_name_length(id_, static_cast<int>(std::clamp<std::int64_t>(longest, MAX_NAME_LENGTH, 4096))));
    std::vector<Entity> result;
    std::vector<char> name(4097);
    for (const int id : ids) {
      std::ranges::fill(name, '\0');
      check_read(ex_get_name(id_, type, id, name.data()));
      result.push_back({id, name.data()});
    }
    return result;
  }

  // Null for lines, points and others that we have none of.
  static const ExodusKind* kind_of_type(std::string type, int corners) {
    for (char& c : type) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const auto known =
        std::ranges::find_if(exodus_kinds(), [&](const ExodusKind& kind) { return type.starts_with(kind.prefix); });
    if (known == exodus_kinds().end()) {
      if (type.starts_with("NSIDED") || type.starts_with("NFACED"))
        fail_expected("hexes, prisms, pyramids or tets", type);
      return nullptr;
    }
    if (corners != known->corners)
      fail_expected("elements of first order only", type + " of " + std::to_string(corners) + " points");
    return &*known;
  }

  void read_blocks() {
    for (const Entity& entity : entities(EX_ELEM_BLOCK, block_count_)) {
      std::array<char, MAX_STR_LENGTH + 1> type{};
      int elements = 0, corners = 0, edges = 0, faces = 0, attributes = 0;
      check_read(
          ex_get_block(id_, EX_ELEM_BLOCK, entity.id, type.data(), &elements, &corners, &edges, &faces, &attributes));
      const std::size_t size = count(elements, "elements");
      const ExodusKind* const kind = size == 0 ? nullptr : kind_of_type(type.data(), corners);
      blocks_.push_back({kind, size, {}});
      if (kind == nullptr) continue;
      std::vector<int>& list = blocks_.back().corners;
      list.resize(count(static_cast<std::int64_t>(size) * corners, "corners of elements"));
      check_read(ex_get_conn(id_, EX_ELEM_BLOCK, entity.id, list.data(), nullptr, nullptr));
      add_block(*kind, entity, list);
    }
  }

  void add_block(const ExodusKind& kind, const Entity& entity, std::vector<int>& list) {
    ElementGroup group{.kind = kind.vtk, .number = static_cast<std::int32_t>(entity.id), .name = entity.name};
    for (int& v : list) {
      if (v < 1 || static_cast<std::size_t>(v) > point_count_)
        fail_expected("points from 1 to " + std::to_string(point_count_), v);
      group.corners.push_back(--v);
    }
    (corners_of_kind(kind.vtk) > 3 && !kind.sides.empty() ? mesh_.cells : mesh_.facets).push_back(std::move(group));
  }

  // Cells in the order of their numbers, where these are all different.
  void number_elements() {
    std::size_t total = 0;
    for (const Block& block : blocks_) total += block.size;
    if (total != element_count_) fail_expected(std::to_string(element_count_) + " elements in the blocks", total);
    std::vector<int> numbers(total);
    if (total > 0) check_read(ex_get_id_map(id_, EX_ELEM_MAP, numbers.data()));
    std::size_t at = 0, group = 0;
    for (const Block& block : blocks_) {
      if (block.kind != nullptr && !block.kind->sides.empty()) {
        auto& places = mesh_.cells[group++].places;
        for (std::size_t i = 0; i < block.size; ++i) places.push_back(numbers[at + i]);
      }
      at += block.size;
    }
  }

  void read_side_sets() {
    for (const Entity& entity : entities(EX_SIDE_SET, set_count_)) {
      int found = 0, factors = 0;
      check_read(ex_get_set_param(id_, EX_SIDE_SET, entity.id, &found, &factors));
      const std::size_t size = count(found, "sides");
      std::vector<int> elements(size), sides(size);
      if (size > 0) check_read(ex_get_set(id_, EX_SIDE_SET, entity.id, elements.data(), sides.data()));
      ElementGroup triangles{.kind = 5, .number = static_cast<std::int32_t>(entity.id), .name = entity.name};
      ElementGroup quads{.kind = 9, .number = triangles.number, .name = entity.name};
      for (std::size_t i = 0; i < size; ++i) add_side(elements[i], sides[i], triangles, quads);
      for (ElementGroup* const group : {&triangles, &quads})
        if (!group->corners.empty()) mesh_.facets.push_back(std::move(*group));
    }
  }

  void add_side(int element, int side, ElementGroup& triangles, ElementGroup& quads) const {
    if (element < 1 || static_cast<std::size_t>(element) > element_count_)
      fail_expected("elements from 1 to " + std::to_string(element_count_) + " in side sets", element);
    auto at = static_cast<std::size_t>(element) - 1;
    auto block = blocks_.begin();
    while (at >= block->size) at -= block++->size;
    if (block->kind == nullptr || block->kind->sides.empty()) return;  // of lines and shells
    const auto& known = block->kind->sides;
    if (side < 1 || static_cast<std::size_t>(side) > known.size())
      fail_expected("sides from 1 to " + std::to_string(known.size()), side);
    const Side& corners = known[static_cast<std::size_t>(side) - 1];
    ElementGroup& group = corners[3] < 0 ? triangles : quads;
    for (const int corner : corners)
      if (corner >= 0)
        group.corners.push_back(
            block->corners[at * static_cast<std::size_t>(block->kind->corners) + static_cast<std::size_t>(corner)]);
  }

  struct Block {
    const ExodusKind* kind;
    std::size_t size;
    std::vector<int> corners;  // from 0
  };

  ExodusFile file_;
  int id_;
  std::uint64_t most_numbers_;
  std::size_t point_count_ = 0, element_count_ = 0, block_count_ = 0, set_count_ = 0;
  std::vector<Block> blocks_;
  GroupedMesh mesh_;
};

void write_mesh(const GroupedMesh& mesh, const std::string& path) {
  const QuietLibrary quiet;
  ex_opts(EX_DEFAULT);
  ExodusWriter(mesh, path).write();
}

GroupedMesh read_mesh(const std::string& path) {
  const QuietLibrary quiet;
  ex_opts(EX_DEFAULT);
  return ExodusReader(path).read();
}

}  // namespace
}  // namespace hexpipe::formats

extern "C" __attribute__((visibility("default"))) const hexpipe::formats::MeshLibrary* hexpipe_mesh_library() {
  static const hexpipe::formats::MeshLibrary library{HEXPIPE_VERSION, hexpipe::formats::write_mesh,
                                                     hexpipe::formats::read_mesh};
  return &library;
}
