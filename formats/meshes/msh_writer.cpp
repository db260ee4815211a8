#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "formats/meshes/cell_data.hpp"
#include "formats/meshes/element_nodes.hpp"
#include "formats/meshes/group_naming.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/meshes/msh.hpp"
#include "formats/meshes/msh_collector.hpp"
#include "formats/streams/number_writer.hpp"

namespace hexpipe::formats {
namespace {

// Netgen cuts names at blanks, and quotes end them.
constexpr NameRules msh_rules{
    .format = ".msh", .longest = 127, .others = "!#$%&'()*+,-./:;<=>?@[]^`{|}~", .ascii_only = false};

// A physical group and the entity with the same number: all cells or all facets with one tag.
struct Group {
  std::int32_t tag;
  std::int32_t number;  // positive: the tag, or a number that no tag has
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 high = -1.0 * low;

  void extend(const Vec3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
};

// The groups of one dimension, by ascending tag; their boxes where the version has them.
class Groups {
 public:
  Groups(const MixedMesh& mesh, int dimension, MshVersion version,
         const std::map<std::int32_t, std::int32_t>& numbers) {
    for (const auto& [tag, number] : numbers) list_.push_back({tag, number});
    if (version == MshVersion::v2_2) return;
    for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
      if (names.dimension == dimension) extend_boxes(mesh, names.vtk, block);
    });
  }

  const std::vector<Group>& list() const { return list_; }
  std::size_t index_of(std::int32_t tag) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(list_, tag, {}, &Group::tag) - list_.begin());
  }

 private:
  template <class Block>
  void extend_boxes(const MixedMesh& mesh, std::uint8_t vtk, const Block& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      Group& group = list_[index_of(block.tags[i])];
      for (const Vertex v : block.cells[i]) group.extend(mesh.points[static_cast<std::size_t>(v)]);
      if (!mesh.second_order) continue;
      for (const Vertex v : mesh.second_order->of(vtk, i)) group.extend(mesh.points[static_cast<std::size_t>(v)]);
    }
  }

  std::vector<Group> list_;
};

// The numbers of a section, as text or as the machine's bytes in the same order.
class MshSink {
 public:
  MshSink(Output& output, MshCoding coding) : output_(output), line_(output), binary_(coding == MshCoding::binary) {}

  void integer(std::int32_t number) { put(number); }
  void size(std::uint64_t number) { put(number); }
  void real(double number) { put(number); }
  void end_line() {
    if (!binary_) line_.end_line();
  }
  // Before the line that ends a section.
  void end_section() {
    if (binary_) output_.write("\n");
  }
  bool is_binary() const { return binary_; }

 private:
  template <class T>
  void put(T number) {
    if (binary_)
      write_bytes(output_, number);
    else
      line_ << number;
  }

  Output& output_;
  LineWriter line_;
  bool binary_;
};

class MshWriter {
 public:
  MshWriter(const MixedMesh& mesh, MshVersion version, MshCoding coding, const MeshWriting& writing, Output& output)
      : mesh_(mesh),
        version_(version),
        output_(output),
        sink_(output, coding),
        names_(mesh, writing, msh_rules),
        numbers_(group_numbers(mesh, version == MshVersion::v2_2)),
        surfaces_(mesh, 2, version, numbers_.surfaces),
        regions_(mesh, 3, version, numbers_.regions),
        lister_(mesh, gmsh_nodes) {}

  void write() {
    write_format();
    write_group_names();
    if (version_ == MshVersion::v4_1) {
      write_entities();
      write_nodes_4();
      write_elements_4();
      if (has_quality(mesh_)) write_quality();
    } else {
      write_nodes_2();
      write_elements_2();
    }
  }

 private:
  const Groups& groups(int dimension) const { return dimension == 3 ? regions_ : surfaces_; }

  void write_format() {
    output_.print("$MeshFormat\n{} {} 8\n", version_ == MshVersion::v4_1 ? "4.1" : "2.2", sink_.is_binary() ? 1 : 0);
    if (sink_.is_binary()) {
      sink_.integer(1);  // tells the byte order
      sink_.end_section();
    }
    output_.print("$EndMeshFormat\n");
  }

  void write_group_names() {
    output_.print("$PhysicalNames\n{}\n", surfaces_.list().size() + regions_.list().size());
    for (const int dimension : {2, 3})
      for (const Group& group : groups(dimension).list())
        output_.print("{} {} \"{}\"\n", dimension, group.number,
                      (dimension == 3 ? names_.regions : names_.surfaces).of(group.tag));
    output_.print("$EndPhysicalNames\n");
  }

  void write_entities() {
    output_.print("$Entities\n");
    for (const std::size_t count : {std::size_t{0}, std::size_t{0}, surfaces_.list().size(), regions_.list().size()})
      sink_.size(count);
    sink_.end_line();
    for (const int dimension : {2, 3})
      for (const Group& group : groups(dimension).list()) write_entity(group);
    sink_.end_section();
    output_.print("$EndEntities\n");
  }

  void write_entity(const Group& group) {
    sink_.integer(group.number);
    for (const Vec3& corner : {group.low, group.high})
      for (int axis = 0; axis < 3; ++axis) sink_.real(corner[axis]);
    sink_.size(1);  // physical groups
    sink_.integer(group.number);
    sink_.size(0);  // bounding entities
    sink_.end_line();
  }

  // All nodes are in one block, of the first volume (or surface).
  void write_nodes_4() {
    const std::uint64_t count = mesh_.points.size();
    const int dimension = regions_.list().empty() ? 2 : 3;
    const auto& list = groups(dimension).list();
    output_.print("$Nodes\n");
    for (const std::uint64_t number : {std::uint64_t{count > 0}, count, std::uint64_t{count > 0}, count})
      sink_.size(number);
    sink_.end_line();
    if (count > 0) {
      for (const std::int32_t number : {dimension, list.empty() ? 1 : list.front().number, 0}) sink_.integer(number);
      sink_.size(count);
      sink_.end_line();
    }
    for (std::uint64_t node = 1; node <= count; ++node) {
      sink_.size(node);
      sink_.end_line();
    }
    for (const Vec3& p : mesh_.points) write_point(p);
    sink_.end_section();
    output_.print("$EndNodes\n");
  }

  void write_point(const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) sink_.real(p[axis]);
    sink_.end_line();
  }

  void write_nodes_2() {
    output_.print("$Nodes\n{}\n", mesh_.points.size());
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
      sink_.integer(static_cast<std::int32_t>(i + 1));
      write_point(mesh_.points[i]);
    }
    sink_.end_section();
    output_.print("$EndNodes\n");
  }

  // A block of the file is a run of elements of one kind with one tag, so that the order of the mesh is kept, and the
  // numbers of the elements are in sequence, which meshio relies on for data in binary.
  void write_elements_4() {
    std::uint64_t runs = 0;
    for_each_block(mesh_, [&](const ElementNames&, const auto& block) {
      for (std::size_t i = 0; i < block.size(); i = end_of_run(block.tags, i)) ++runs;
    });
    const std::uint64_t count = element_count(mesh_);
    output_.print("$Elements\n");
    for (const std::uint64_t number : {runs, count, std::uint64_t{count > 0}, count}) sink_.size(number);
    sink_.end_line();
    std::uint64_t element = 0;
    for_each_block(mesh_, [&](const ElementNames& names, const auto& block) {
      for (std::size_t i = 0; i < block.size(); i = end_of_run(block.tags, i))
        write_run_4(names, block, i, end_of_run(block.tags, i), element);
    });
    sink_.end_section();
    output_.print("$EndElements\n");
  }

  static std::size_t end_of_run(const std::vector<std::int32_t>& tags, std::size_t begin) {
    std::size_t end = begin;
    while (end < tags.size() && tags[end] == tags[begin]) ++end;
    return end;
  }

  template <class Block>
  void write_run_4(const ElementNames& names, const Block& block, std::size_t begin, std::size_t end,
                   std::uint64_t& element) {
    const std::int32_t entity = group_of(names.dimension, block.tags[begin]);
    for (const std::int32_t number : {names.dimension, entity, int{names.gmsh_of(mesh_)}}) sink_.integer(number);
    sink_.size(end - begin);
    sink_.end_line();
    for (std::size_t i = begin; i < end; ++i) {
      sink_.size(++element);
      for (const Vertex v : lister_.nodes(names.vtk, block, i)) sink_.size(static_cast<std::uint64_t>(v) + 1);
      sink_.end_line();
    }
  }

  std::int32_t group_of(int dimension, std::int32_t tag) const {
    const Groups& all = groups(dimension);
    return all.list()[all.index_of(tag)].number;
  }

  void write_elements_2() {
    output_.print("$Elements\n{}\n", element_count(mesh_));
    std::int32_t element = 0;
    for_each_block(mesh_, [&](const ElementNames& names, const auto& block) {
      write_run_head_2(names, block.size());
      for (std::size_t i = 0; i < block.size(); ++i) {
        const std::int32_t group = group_of(names.dimension, block.tags[i]);
        sink_.integer(++element);
        if (!sink_.is_binary())
          for (const std::int32_t number : {int{names.gmsh_of(mesh_)}, 2}) sink_.integer(number);
        // Physical group and elementary entity.
        for (const std::int32_t number : {group, group}) sink_.integer(number);
        for (const Vertex v : lister_.nodes(names.vtk, block, i)) sink_.integer(v + 1);
        sink_.end_line();
      }
    });
    sink_.end_section();
    output_.print("$EndElements\n");
  }

  // In binary, type and number of tags stand once for all elements of a block.
  void write_run_head_2(const ElementNames& names, std::size_t count) {
    if (!sink_.is_binary() || count == 0) return;
    for (const std::int32_t number : {int{names.gmsh_of(mesh_)}, static_cast<std::int32_t>(count), 2})
      sink_.integer(number);
  }

  void write_quality() {
    const std::vector<double> quality = cell_data(mesh_).quality;
    output_.print("$ElementData\n1\n\"{}\"\n1\n0\n3\n0\n1\n{}\n", quality_name, quality.size());
    std::int32_t element = 0;
    for (const double value : quality) {
      sink_.integer(++element);
      sink_.real(value);
      sink_.end_line();
    }
    sink_.end_section();
    output_.print("$EndElementData\n");
  }

  const MixedMesh& mesh_;
  MshVersion version_;
  Output& output_;
  MshSink sink_;
  GroupNamings names_;
  GroupNumbers numbers_;
  Groups surfaces_, regions_;
  NodeLister lister_;
};

}  // namespace

void write_msh(const MixedMesh& mesh, MshVersion version, MshCoding coding, const MeshWriting& writing,
               Output& output) {
  MshWriter(mesh, version, coding, writing, output).write();
}

}  // namespace hexpipe::formats
