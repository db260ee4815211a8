// The module for CGNS, by the library of its committee, on HDF5. Written only.

#include <cgnslib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "formats/meshes/libraries/hdf5_bytes.hpp"
#include "formats/meshes/libraries/library_errors.hpp"
#include "formats/meshes/mesh_library.hpp"

namespace hexpipe::formats {
namespace {

// Elements of all kinds have their corners in our order.
CGNS_ENUMT(ElementType_t) type_of(std::uint8_t vtk) {
  switch (vtk) {
    case 12:
      return CGNS_ENUMV(HEXA_8);
    case 13:
      return CGNS_ENUMV(PENTA_6);
    case 14:
      return CGNS_ENUMV(PYRA_5);
    case 10:
      return CGNS_ENUMV(TETRA_4);
    case 5:
      return CGNS_ENUMV(TRI_3);
    default:
      return CGNS_ENUMV(QUAD_4);
  }
}

void check(int result) {
  if (result != CG_OK) fail(errno != 0 ? std::strerror(errno) : cg_get_error());
}

class CgnsWriter {
 public:
  CgnsWriter(const GroupedMesh& mesh, const std::string& path) : mesh_(mesh) {
    check(cg_set_file_type(CG_FILE_HDF5));
    check(cg_open(path.c_str(), CG_MODE_WRITE, &file_));
  }
  ~CgnsWriter() {
    if (file_ >= 0) cg_close(file_);
  }
  CgnsWriter(const CgnsWriter&) = delete;
  CgnsWriter& operator=(const CgnsWriter&) = delete;

  void write() {
    write_zone();
    write_points();
    for (const ElementGroup& cells : mesh_.cells) write_section(cells.name, cells);
    write_surfaces();
    check(cg_close(std::exchange(file_, -1)));
  }

 private:
  void write_zone() {
    cgsize_t cells = 0;
    for (const ElementGroup& group : mesh_.cells) cells += static_cast<cgsize_t>(group.size());
    check(cg_base_write(file_, "Base", 3, 3, &base_));
    const std::array<cgsize_t, 3> sizes{static_cast<cgsize_t>(mesh_.points.size()), cells, 0};
    check(cg_zone_write(file_, base_, "Zone", sizes.data(), CGNS_ENUMV(Unstructured), &zone_));
  }

  void write_points() {
    std::vector<double> list(mesh_.points.size());
    const auto write = [&](const char* name, double Vec3::*axis) {
      std::ranges::transform(mesh_.points, list.begin(), [&](const Vec3& p) { return p.*axis; });
      int coordinate = 0;
      check(cg_coord_write(file_, base_, zone_, CGNS_ENUMV(RealDouble), name, list.data(), &coordinate));
    };
    write("CoordinateX", &Vec3::x), write("CoordinateY", &Vec3::y), write("CoordinateZ", &Vec3::z);
  }

  // Elements are numbered from 1 through all sections.
  void write_section(const std::string& name, const ElementGroup& group) {
    std::vector<cgsize_t> corners;
    corners.reserve(group.corners.size());
    for (const Vertex v : group.corners) corners.push_back(v + 1);
    const cgsize_t end = next_ + static_cast<cgsize_t>(group.size());
    int section = 0;
    check(cg_section_write(file_, base_, zone_, name.c_str(), type_of(group.kind), next_, end - 1, 0, corners.data(),
                           &section));
    next_ = end;
  }

  // A surface's triangles and quads follow each other, so that they are one range for its condition.
  void write_surfaces() {
    std::map<std::int32_t, std::vector<const ElementGroup*>> surfaces;
    for (const ElementGroup& group : mesh_.facets) surfaces[group.number].push_back(&group);
    for (const auto& [number, groups] : surfaces) {
      const cgsize_t first = next_;
      const std::string& name = groups.front()->name;
      for (const ElementGroup* const group : groups)
        write_section(groups.size() == 1 ? name : name + (group->kind == 5 ? "_tri" : "_quad"), *group);
      write_condition(name, {first, next_ - 1});
    }
  }

  void write_condition(const std::string& name, const std::array<cgsize_t, 2>& range) {
    int family = 0, condition = 0;
    check(cg_family_write(file_, base_, name.c_str(), &family));
    check(cg_boco_write(file_, base_, zone_, name.c_str(), CGNS_ENUMV(FamilySpecified), CGNS_ENUMV(PointRange), 2,
                        range.data(), &condition));
    check(cg_boco_gridlocation_write(file_, base_, zone_, condition, CGNS_ENUMV(FaceCenter)));
    check(cg_goto(file_, base_, "Zone_t", zone_, "ZoneBC_t", 1, "BC_t", condition, "end"));
    check(cg_famname_write(name.c_str()));
  }

  const GroupedMesh& mesh_;
  int file_ = -1, base_ = 0, zone_ = 0;
  cgsize_t next_ = 1;
};

void write_mesh(const GroupedMesh& mesh, const std::string& path) {
  const QuietLibrary quiet;
  errno = 0;
  CgnsWriter(mesh, path).write();
  clear_hdf5_traces(path);
}

}  // namespace
}  // namespace hexpipe::formats

extern "C" __attribute__((visibility("default"))) const hexpipe::formats::MeshLibrary* hexpipe_mesh_library() {
  static const hexpipe::formats::MeshLibrary library{HEXPIPE_VERSION, hexpipe::formats::write_mesh, nullptr};
  return &library;
}
