// The module for MED, by EDF's library on HDF5.

#include <med.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "formats/meshes/element_nodes.hpp"
#include "formats/meshes/libraries/hdf5_bytes.hpp"
#include "formats/meshes/libraries/library_errors.hpp"
#include "formats/meshes/mesh_library.hpp"

namespace hexpipe::formats {
namespace {

// Corner i of MED's element is corner order[i] of ours: MED's cells are seen from the other side.
struct MedKind {
  std::uint8_t vtk;
  med_geometry_type type;
  std::vector<std::size_t> order;
};

const std::vector<MedKind>& med_kinds() {
  static const std::vector<MedKind> kinds{{12, MED_HEXA8, {0, 3, 2, 1, 4, 7, 6, 5}},
                                          {13, MED_PENTA6, {0, 2, 1, 3, 5, 4}},
                                          {14, MED_PYRA5, {0, 3, 2, 1, 4}},
                                          {10, MED_TETRA4, {0, 2, 1, 3}},
                                          {5, MED_TRIA3, {0, 1, 2}},
                                          {9, MED_QUAD4, {0, 1, 2, 3}}};
  return kinds;
}

// Types of elements that no mesh of ours has; lines and points are skipped.
struct RefusedType {
  med_geometry_type type;
  const char* name;
};
constexpr std::array refused_types{RefusedType{MED_TRIA6, "TRIA6"},     RefusedType{MED_TRIA7, "TRIA7"},
                                   RefusedType{MED_QUAD8, "QUAD8"},     RefusedType{MED_QUAD9, "QUAD9"},
                                   RefusedType{MED_TETRA10, "TETRA10"}, RefusedType{MED_PYRA13, "PYRA13"},
                                   RefusedType{MED_PENTA15, "PENTA15"}, RefusedType{MED_PENTA18, "PENTA18"},
                                   RefusedType{MED_HEXA20, "HEXA20"},   RefusedType{MED_HEXA27, "HEXA27"},
                                   RefusedType{MED_POLYGON, "POLYGON"}, RefusedType{MED_POLYGON2, "POLYGON2"},
                                   RefusedType{MED_OCTA12, "OCTA12"},   RefusedType{MED_POLYHEDRON, "POLYHEDRON"}};

// The library says that a call failed, and prints why; the system knows where it was at fault.
std::string reason_of_failure(const char* what) {
  return errno != 0 ? std::strerror(errno) : std::string("MED: ") + what + " failed";
}

class MedFile {
 public:
  explicit MedFile(med_idt id) : id_(id) {}
  ~MedFile() {
    if (id_ >= 0) MEDfileClose(id_);
  }
  MedFile(const MedFile&) = delete;
  MedFile& operator=(const MedFile&) = delete;

  med_idt id() const { return id_; }
  med_err close() { return MEDfileClose(std::exchange(id_, -1)); }

 private:
  med_idt id_;
};

// Text that fills a field of this length, as the library wants all of them.
template <std::size_t length>
std::array<char, length + 1> field(const std::string& text) {
  std::array<char, length + 1> result{};
  std::ranges::copy(text.substr(0, length), result.begin());
  return result;
}

class MedWriter {
 public:
  MedWriter(const GroupedMesh& mesh, const std::string& path)
      : mesh_(mesh),
        mesh_name_(field<MED_NAME_SIZE>(mesh.name)),
        file_(MEDfileOpen(path.c_str(), MED_ACC_CREAT)),
        id_(file_.id()) {
    check(static_cast<med_err>(std::min<med_idt>(id_, 0)), "creating the file");
  }

  void write() {
    write_mesh();
    write_points();
    write_families();
    for (const MedKind& kind : med_kinds()) write_elements(kind);
    check(file_.close(), "closing the file");
  }

 private:
  static void check(med_err result, const char* what) {
    if (result < 0) fail(reason_of_failure(what));
  }

  void write_mesh() {
    std::string axes, units(3 * MED_SNAME_SIZE, ' ');
    for (const char axis : {'x', 'y', 'z'}) axes += axis + std::string(MED_SNAME_SIZE - 1, ' ');
    check(MEDmeshCr(id_, mesh_name_.data(), 3, 3, MED_UNSTRUCTURED_MESH, "hexpipe mesh", "", MED_SORT_DTIT,
                    MED_CARTESIAN, axes.c_str(), units.c_str()),
          "writing the mesh");
  }

  void write_points() {
    std::vector<med_float> coordinates;
    coordinates.reserve(3 * mesh_.points.size());
    for (const Vec3& p : mesh_.points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
    if (!coordinates.empty())
      check(MEDmeshNodeCoordinateWr(id_, mesh_name_.data(), MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_FULL_INTERLACE,
                                    static_cast<med_int>(mesh_.points.size()), coordinates.data()),
            "writing points");
  }

  // One for each group; those of elements have numbers below 0.
  void write_families() {
    check(MEDfamilyCr(id_, mesh_name_.data(), MED_NO_NAME, 0, 0, MED_NO_GROUP), "writing families");
    std::set<std::int32_t> written;
    for (const auto* const groups : {&mesh_.facets, &mesh_.cells})
      for (const ElementGroup& group : *groups) {
        if (!written.insert(group.number).second) continue;
        const std::string name = "FAM_-" + std::to_string(group.number);
        check(MEDfamilyCr(id_, mesh_name_.data(), name.c_str(), -group.number, 1,
                          field<MED_LNAME_SIZE>(group.name).data()),
              "writing families");
      }
  }

  // MED's number of a type tells its nodes: 320 is a hex of 20.
  static med_geometry_type type_of(const MedKind& kind, std::size_t nodes) {
    return kind.type / 100 * 100 + static_cast<med_geometry_type>(nodes);
  }

  // In the order that elements have in the mesh, whatever their groups.
  void write_elements(const MedKind& kind) {
    struct Element {
      std::int64_t place;
      const ElementGroup* group;
      std::size_t index;
    };
    std::vector<Element> elements;
    for (const auto* const groups : {&mesh_.cells, &mesh_.facets})
      for (const ElementGroup& group : *groups)
        for (std::size_t i = 0; group.kind == kind.vtk && i < group.size(); ++i)
          elements.push_back({group.places[i], &group, i});
    if (elements.empty()) return;
    std::ranges::sort(elements, {}, &Element::place);
    std::vector<med_int> corners, families;
    const std::vector<std::size_t> order = node_order(med_nodes, kind.vtk, mesh_.second_order, mesh_.full);
    std::vector<Vertex> nodes;
    for (const Element& element : elements) {
      families.push_back(-element.group->number);
      nodes.clear();
      list_nodes(*element.group, element.index, order, nodes);
      for (const Vertex v : nodes) corners.push_back(v + 1);
    }
    const med_geometry_type type = type_of(kind, order.size());
    const auto count = static_cast<med_int>(elements.size());
    check(MEDmeshElementConnectivityWr(id_, mesh_name_.data(), MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_CELL, type,
                                       MED_NODAL, MED_FULL_INTERLACE, count, corners.data()),
          "writing elements");
    check(MEDmeshEntityFamilyNumberWr(id_, mesh_name_.data(), MED_NO_DT, MED_NO_IT, MED_CELL, type, count,
                                      families.data()),
          "writing families of elements");
  }

  const GroupedMesh& mesh_;
  std::array<char, MED_NAME_SIZE + 1> mesh_name_;
  MedFile file_;
  med_idt id_;
};

class MedReader {
 public:
  explicit MedReader(const std::string& path)
      : file_(MEDfileOpen(path.c_str(), MED_ACC_RDONLY)), id_(file_.id()), most_numbers_(most_numbers_in(path)) {
    check(static_cast<med_err>(std::min<med_idt>(id_, 0)), "opening the file");
  }

  GroupedMesh read() {
    read_mesh();
    refuse_other_elements();
    read_points();
    read_families();
    for (const MedKind& kind : med_kinds()) read_elements(kind, kind.order.size());
    set_groups();
    return std::move(mesh_);
  }

 private:
  static void check(med_err result, const char* what) {
    if (result < 0) fail("cannot read as MED: " + std::string(what) + " failed");
  }

  void read_mesh() {
    const med_int meshes = MEDnMesh(id_);
    check(std::min(meshes, 0), "reading the mesh");
    if (meshes != 1) fail_expected("one mesh", meshes);
    const med_int axes = MEDmeshnAxis(id_, 1);
    check(std::min(axes, 0), "reading the mesh");
    if (axes != 3) fail_expected("3 dimensions", axes);
    std::array<char, MED_NAME_SIZE + 1> name{};
    std::array<char, MED_COMMENT_SIZE + 1> description{};
    std::array<char, 3 * MED_SNAME_SIZE + 1> time_unit{}, axis_names{}, axis_units{};
    med_int space = 0, dimension = 0, steps = 0;
    med_mesh_type type{};
    med_sorting_type sorting{};
    med_axis_type axis{};
    check(MEDmeshInfo(id_, 1, name.data(), &space, &dimension, &type, description.data(), time_unit.data(), &sorting,
                      &steps, &axis, axis_names.data(), axis_units.data()),
          "reading the mesh");
    if (type != MED_UNSTRUCTURED_MESH) fail("expected an unstructured mesh, found a structured one");
    if (axis != MED_CARTESIAN) fail("expected Cartesian coordinates, found others");
    name_ = name.data();
    if (steps > 1) fail_expected("a mesh at one time", steps);
    med_float time = 0;
    if (steps == 1)
      check(MEDmeshComputationStepInfo(id_, name_.c_str(), 1, &step_, &iteration_, &time), "reading the mesh");
  }

  std::size_t count_of(med_entity_type entity, med_geometry_type type, med_data_type data) const {
    med_bool changed{}, transformed{};
    const med_int found = MEDmeshnEntity(id_, name_.c_str(), step_, iteration_, entity, type, data,
                                         data == MED_COORDINATE ? MED_NO_CMODE : MED_NODAL, &changed, &transformed);
    if (found <= 0) return 0;
    if (static_cast<std::uint64_t>(found) > most_numbers_)
      fail_expected("as many elements as the file has room for", found);
    return static_cast<std::size_t>(found);
  }

  void refuse_other_elements() const {
    for (const RefusedType& refused : refused_types) {
      const bool has_index =
          refused.type == MED_POLYGON || refused.type == MED_POLYGON2 || refused.type == MED_POLYHEDRON;
      if (count_of(MED_CELL, refused.type, has_index ? MED_INDEX_NODE : MED_CONNECTIVITY) > 0)
        fail_expected("hexes, prisms, pyramids and tets of first order", std::string(refused.name));
    }
  }

  void read_points() {
    const std::size_t count = count_of(MED_NODE, MED_NONE, MED_COORDINATE);
    std::vector<med_float> coordinates(3 * count);
    if (count > 0)
      check(MEDmeshNodeCoordinateRd(id_, name_.c_str(), step_, iteration_, MED_FULL_INTERLACE, coordinates.data()),
            "reading points");
    for (std::size_t i = 0; i < count; ++i)
      mesh_.points.push_back({coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]});
  }

  void read_families() {
    const med_int count = MEDnFamily(id_, name_.c_str());
    check(std::min(count, 0), "reading families");
    for (int i = 1; i <= count; ++i) {
      const med_int groups = MEDnFamilyGroup(id_, name_.c_str(), i);
      check(std::min(groups, 0), "reading families");
      if (static_cast<std::uint64_t>(groups) > most_numbers_) fail_expected("groups of a family", groups);
      std::array<char, MED_NAME_SIZE + 1> name{};
      std::vector<char> names(static_cast<std::size_t>(groups) * MED_LNAME_SIZE + 1);
      med_int number = 0;
      check(MEDfamilyInfo(id_, name_.c_str(), i, name.data(), &number, names.data()), "reading families");
      for (std::size_t g = 0; g < static_cast<std::size_t>(groups); ++g) {
        const char* const begin = names.data() + g * MED_LNAME_SIZE;
        std::string group(begin, strnlen(begin, MED_LNAME_SIZE));
        while (group.ends_with(' ')) group.pop_back();
        groups_of_family_[number].push_back(std::move(group));
      }
    }
  }

  void read_elements(const MedKind& kind, std::size_t corner_count) {
    const std::size_t count = count_of(MED_CELL, kind.type, MED_CONNECTIVITY);
    if (count == 0) return;
    if (count > most_numbers_ / corner_count) fail_expected("as many elements as the file has room for", count);
    std::vector<med_int> corners(count * corner_count), families(count);
    check(MEDmeshElementConnectivityRd(id_, name_.c_str(), step_, iteration_, MED_CELL, kind.type, MED_NODAL,
                                       MED_FULL_INTERLACE, corners.data()),
          "reading elements");
    med_bool changed{}, transformed{};
    const med_int with_family = MEDmeshnEntity(id_, name_.c_str(), step_, iteration_, MED_CELL, kind.type,
                                               MED_FAMILY_NUMBER, MED_NODAL, &changed, &transformed);
    if (with_family > 0) {
      if (static_cast<std::size_t>(with_family) != count) fail_expected("a family for each element", with_family);
      check(MEDmeshEntityFamilyNumberRd(id_, name_.c_str(), step_, iteration_, MED_CELL, kind.type, families.data()),
            "reading families of elements");
    }
    add_elements(kind, corners, families);
  }

  void add_elements(const MedKind& kind, const std::vector<med_int>& corners, const std::vector<med_int>& families) {
    const std::size_t corner_count = kind.order.size();
    std::map<med_int, ElementGroup> groups;
    for (std::size_t i = 0; i < families.size(); ++i) {
      ElementGroup& group = groups[families[i]];
      std::array<Vertex, 8> element{};
      for (std::size_t c = 0; c < corner_count; ++c) {
        const med_int v = corners[i * corner_count + c];
        if (v < 1 || static_cast<std::size_t>(v) > mesh_.points.size())
          fail_expected("points from 1 to " + std::to_string(mesh_.points.size()), v);
        element[kind.order[c]] = v - 1;
      }
      group.corners.insert(group.corners.end(), element.begin(),
                           element.begin() + static_cast<std::ptrdiff_t>(corner_count));
      group.places.push_back(static_cast<std::int64_t>(i));
    }
    auto& list = kind.type == MED_TRIA3 || kind.type == MED_QUAD4 ? mesh_.facets : mesh_.cells;
    for (auto& [family, group] : groups) {
      group.kind = kind.vtk;
      group.number = family;
      list.push_back(std::move(group));
    }
  }

  // A family of several groups gets the name of the smallest, which says most.
  void set_groups() {
    for (auto* const list : {&mesh_.cells, &mesh_.facets}) {
      std::map<std::string, std::size_t> sizes;
      for (const ElementGroup& group : *list)
        for (const std::string& name : groups_of_family_[group.number]) sizes[name] += group.size();
      for (ElementGroup& group : *list) {
        const std::vector<std::string>& names = groups_of_family_[group.number];
        if (!names.empty())
          group.name = *std::ranges::min_element(names, {}, [&](const std::string& name) { return sizes[name]; });
        group.number = group.number == std::numeric_limits<std::int32_t>::min() ? 0 : std::abs(group.number);
      }
    }
  }

  MedFile file_;
  med_idt id_;
  std::uint64_t most_numbers_;
  std::string name_;
  med_int step_ = MED_NO_DT, iteration_ = MED_NO_IT;
  std::map<med_int, std::vector<std::string>> groups_of_family_;
  GroupedMesh mesh_;
};

void write_mesh(const GroupedMesh& mesh, const std::string& path) {
  const QuietLibrary quiet;
  errno = 0;
  MedWriter(mesh, path).write();
  clear_hdf5_traces(path);
}

GroupedMesh read_mesh(const std::string& path) {
  const QuietLibrary quiet;
  return MedReader(path).read();
}

}  // namespace
}  // namespace hexpipe::formats

extern "C" __attribute__((visibility("default"))) const hexpipe::formats::MeshLibrary* hexpipe_mesh_library() {
  static const hexpipe::formats::MeshLibrary library{HEXPIPE_VERSION, hexpipe::formats::write_mesh,
                                                     hexpipe::formats::read_mesh};
  return &library;
}
