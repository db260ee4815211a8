#include "formats/meshes/openfoam.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "common/mesh/facet_key.hpp"
#include "common/run/error.hpp"
#include "formats/meshes/facet_table.hpp"
#include "formats/meshes/group_naming.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/polyhedra/mend_polyhedra.hpp"
#include "formats/polyhedra/polyhedral_mesh.hpp"
#include "formats/streams/number_writer.hpp"

namespace hexpipe::formats {
namespace {

using polyhedra::PolyhedralMesh;

// Other characters end a word of a dictionary, or mean a pattern.
constexpr NameRules openfoam_rules{.format = "OpenFOAM", .longest = 255, .others = "-.:+%@~^"};
constexpr const char* untagged_patch = "defaultFaces";

using Corners = std::array<Vertex, 4>;

// A triangle has no fourth corner.
template <std::size_t N>
Corners face_corners(const std::array<Vertex, N>& corners) {
  Corners face{no_index, no_index, no_index, no_index};
  std::ranges::copy(corners, face.begin());
  return face;
}

std::size_t corner_count_of(const Corners& face) {
  return face[3] == no_index ? 3 : 4;
}

Corners sorted(Corners face) {
  std::ranges::sort(face);
  return face;
}

struct Face {
  Corners key;      // sorted
  Corners corners;  // outward from the owner
  std::int32_t owner;
  std::int32_t neighbour = no_index;
  std::int32_t surface = no_index;  // the place of its name; no_index: it has no tag
  bool flipped = false;             // whether the facet looks against it
};

bool same_cycle(const Corners& a, const Corners& b) {
  const std::size_t count = corner_count_of(a);
  const auto start = static_cast<std::size_t>(std::ranges::find(b, a[0]) - b.begin());
  for (std::size_t i = 0; i < count; ++i)
    if (a[i] != b[(start + i) % count]) return false;
  return true;
}

// Faces by their vertices: where their surface and cells are the same.
bool is_before(const PolyhedralMesh& mesh, const PolyhedralMesh::Face& a, const PolyhedralMesh::Face& b) {
  const auto vertices_of = [&](const PolyhedralMesh::Face& face) {
    const auto corners = mesh.corners_of(face);
    std::vector<Vertex> vertices(corners.begin(), corners.end());
    std::ranges::sort(vertices);
    return vertices;
  };
  return a.count != b.count ? a.count < b.count : vertices_of(a) < vertices_of(b);
}

class PolyMesh {
 public:
  PolyMesh(const MixedMesh& mesh, const MeshWriting& writing, OutputFolder& folder)
      : mesh_(mesh), writing_(writing), folder_(folder), names_(mesh, writing, openfoam_rules, {untagged_patch}) {
    surface_names_ = names_.surfaces.list();
    region_names_ = names_.regions.list();
    check_numbers(mesh.cell_count() * 6, most_of_31_bits, folder.name());
    collect_faces();
    join_faces();
    check_conformity();
    tag_faces(mesh.triangles);
    tag_faces(mesh.quads);
    tell_of_untagged();
    make_polyhedra();
    if (writing.polyhedra) mend();
    order_faces();
  }

  void write() {
    write_points();
    write_faces();
    write_cells_of_faces();
    write_boundary();
    write_cell_zones();
    write_face_zones();
  }

 private:
  void collect_faces() {
    std::int32_t cell_number = 0;
    const auto collect = [&](auto topology, const auto& block) {
      using Topology = decltype(topology);
      for (const auto& cell : block.cells) {
        for (const auto& t : Topology::triangles) add_face(face_corners(pick(cell, t)), cell_number);
        for (const auto& q : Topology::quads) add_face(face_corners(pick(cell, q)), cell_number);
        ++cell_number;
      }
    };
    collect(HexTopology{}, mesh_.hexes), collect(PrismTopology{}, mesh_.prisms);
    collect(PyramidTopology{}, mesh_.pyramids), collect(TetTopology{}, mesh_.tets);
  }

  void add_face(const Corners& corners, std::int32_t cell) { faces_.push_back({sorted(corners), corners, cell}); }

  // Two cells with the same corners have one face.
  void join_faces() {
    std::ranges::sort(faces_, {}, [](const Face& face) { return std::pair(face.key, face.owner); });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      if (kept == 0 || faces_[kept - 1].key != faces_[i].key) {
        faces_[kept++] = faces_[i];
        continue;
      }
      Face& first = faces_[kept - 1];
      if (first.neighbour != no_index)
        throw DataError::at(folder_.name(), "cannot write cell {}: its face is one of two others, too",
                            faces_[i].owner + 1);
      first.neighbour = faces_[i].owner;
    }
    faces_.resize(kept);
  }

  template <class Block>
  void tag_faces(const Block& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      const Corners corners = face_corners(block.cells[i]);
      const auto found = std::ranges::lower_bound(faces_, sorted(corners), {}, &Face::key);
      if (found == faces_.end() || found->key != sorted(corners))
        throw DataError::at(folder_.name(), "cannot write {}[{}]: it is no face of a cell",
                            corners_of_block<Block> == 3 ? "triangles" : "quads", i);
      const std::string& name = names_.surfaces.of(block.tags[i]);
      found->surface = static_cast<std::int32_t>(std::ranges::find(surface_names_, name) - surface_names_.begin());
      found->flipped = found->neighbour != no_index && !same_cycle(corners, found->corners);
    }
  }

  // A quad against two triangles would be three walls inside the mesh.
  void check_conformity() const {
    const auto is_open = [&](const Triangle& triangle) {
      const Corners key = sorted(face_corners(triangle));
      const auto found = std::ranges::lower_bound(faces_, key, {}, &Face::key);
      return found != faces_.end() && found->key == key && found->neighbour == no_index;
    };
    for (const Face& face : faces_) {
      if (face.neighbour != no_index || corner_count_of(face.corners) != 4) continue;
      for (int diagonal = 0; diagonal < 2; ++diagonal)
        if (std::ranges::all_of(triangles_of(face.corners, diagonal), is_open))
          throw DataError::at(folder_.name(), "cannot write cell {}: a quad of it faces two triangles", face.owner + 1);
    }
  }

  void tell_of_untagged() const {
    const auto count = std::ranges::count_if(
        faces_, [](const Face& face) { return face.neighbour == no_index && face.surface == no_index; });
    if (count > 0) writing_.say(fmt::format("{} faces on no surface become the patch {}", count, untagged_patch));
  }

  void make_polyhedra() {
    result_.points = mesh_.points;
    result_.faces.reserve(faces_.size());
    result_.corners.reserve(faces_.size() * 4);
    for (const Face& face : faces_) {
      result_.add_face(std::span(face.corners).first(corner_count_of(face.corners)), face.owner, face.neighbour);
      result_.faces.back().surface = face.surface;
      result_.faces.back().flipped = face.flipped;
    }
    faces_ = {};
    std::map<std::int32_t, std::int32_t> place;  // by tag
    for_each_block(mesh_, [&](const ElementNames& names, const auto& block) {
      if (names.dimension != 3) return;
      for (const std::int32_t tag : block.tags) {
        const auto [at, is_new] = place.try_emplace(tag);
        if (is_new)
          at->second = static_cast<std::int32_t>(std::ranges::find(region_names_, names_.regions.of(tag)) -
                                                 region_names_.begin());
        result_.regions.push_back(at->second);
      }
    });
    result_.is_hex.assign(result_.regions.size(), 0);
    std::fill_n(result_.is_hex.begin(), mesh_.hexes.size(), 1);
  }

  void mend() {
    std::vector<polyhedra::LayerCell> cells;
    cells.reserve(mesh_.hexes.size() + mesh_.prisms.size());
    std::int32_t number = 0;
    const auto add = [&](CellKind kind, const auto& block) {
      for (const auto& cell : block.cells) {
        cells.push_back({number++, kind, {}});
        std::ranges::copy(cell, cells.back().corners.begin());
      }
    };
    add(CellKind::hex, mesh_.hexes), add(CellKind::prism, mesh_.prisms);
    const polyhedra::MendCounts counts = polyhedra::mend_polyhedra(result_, cells);
    if (const std::string line = polyhedra::summary(counts); !line.empty()) writing_.say(line);
  }

  // Faces inside come first, by owner and neighbour; then the others, by patch.
  void order_faces() {
    std::ranges::sort(result_.faces, [&](const PolyhedralMesh::Face& a, const PolyhedralMesh::Face& b) {
      const auto place = [](const PolyhedralMesh::Face& face) {
        return std::tuple(!face.is_inner(), face.is_inner() ? 0 : face.surface, face.owner, face.neighbour);
      };
      return place(a) != place(b) ? place(a) < place(b) : is_before(result_, a, b);
    });
    inside_ = std::ranges::count_if(result_.faces, &PolyhedralMesh::Face::is_inner);
  }

  Output& open(const char* file, const char* type, const std::string& note = "") {
    Output& output = folder_.add(file);
    output.print("FoamFile\n{{\n    version 2.0;\n    format ascii;\n    class {};\n", type);
    if (!note.empty()) output.print("    note \"{}\";\n", note);
    output.print("    location \"constant/polyMesh\";\n    object {};\n}}\n\n", file);
    return output;
  }

  void write_points() {
    Output& output = open("points", "vectorField");
    output.print("{}\n(\n", result_.points.size());
    for (const Vec3& p : result_.points) output.print("({} {} {})\n", p.x, p.y, p.z);
    output.print(")\n");
    output.drain();
  }

  void write_faces() {
    Output& output = open("faces", "faceList");
    output.print("{}\n(\n", result_.faces.size());
    for (const PolyhedralMesh::Face& face : result_.faces)
      output.print("{}({})\n", face.count, fmt::join(result_.corners_of(face), " "));
    output.print(")\n");
    output.drain();
  }

  void write_cells_of_faces() {
    const auto& faces = result_.faces;
    const std::string note = fmt::format("nPoints: {} nCells: {} nFaces: {} nInternalFaces: {}", result_.points.size(),
                                         result_.regions.size(), faces.size(), inside_);
    Output& owners = open("owner", "labelList", note);
    owners.print("{}\n(\n", faces.size());
    for (const PolyhedralMesh::Face& face : faces) owners.print("{}\n", face.owner);
    owners.print(")\n");
    owners.drain();
    Output& neighbours = open("neighbour", "labelList", note);
    neighbours.print("{}\n(\n", inside_);
    for (const PolyhedralMesh::Face& face : faces)
      if (face.is_inner()) neighbours.print("{}\n", face.neighbour);
    neighbours.print(")\n");
    neighbours.drain();
  }

  // Patches in the order of their faces.
  void write_boundary() {
    struct Patch {
      std::int32_t surface;
      std::size_t start, count;
    };
    std::vector<Patch> patches;
    for (std::size_t i = static_cast<std::size_t>(inside_); i < result_.faces.size(); ++i) {
      const std::int32_t surface = result_.faces[i].surface;
      if (patches.empty() || patches.back().surface != surface) patches.push_back({surface, i, 0});
      ++patches.back().count;
    }
    Output& output = open("boundary", "polyBoundaryMesh");
    output.print("{}\n(\n", patches.size());
    for (const Patch& patch : patches)
      output.print("    {}\n    {{\n        type patch;\n        nFaces {};\n        startFace {};\n    }}\n",
                   patch.surface == no_index ? untagged_patch : surface_names_[static_cast<std::size_t>(patch.surface)],
                   patch.count, patch.start);
    output.print(")\n");
    output.drain();
  }

  void write_cell_zones() {
    std::vector<std::vector<std::int32_t>> cells(region_names_.size());
    for (std::size_t cell = 0; cell < result_.regions.size(); ++cell)
      cells[static_cast<std::size_t>(result_.regions[cell])].push_back(static_cast<std::int32_t>(cell));
    Output& output = open("cellZones", "regIOobject");
    output.print("{}\n(\n", cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      output.print("{}\n{{\n    type cellZone;\n    cellLabels List<label>\n{}\n(\n{}\n)\n;\n}}\n", region_names_[i],
                   cells[i].size(), fmt::join(cells[i], "\n"));
    output.print(")\n");
    output.drain();
  }

  // For the surfaces that have cells on both sides.
  void write_face_zones() {
    std::map<std::int32_t, std::vector<std::size_t>> zones;
    for (std::size_t i = 0; i < static_cast<std::size_t>(inside_); ++i)
      if (result_.faces[i].surface != no_index) zones[result_.faces[i].surface].push_back(i);
    Output& output = open("faceZones", "regIOobject");
    output.print("{}\n(\n", zones.size());
    for (const auto& [surface, list] : zones) {
      output.print(
          "{}\n{{\n    type faceZone;\n    faceLabels List<label>\n{}\n(\n{}\n)\n;\n    flipMap List<bool>\n{}\n(\n",
          surface_names_[static_cast<std::size_t>(surface)], list.size(), fmt::join(list, "\n"), list.size());
      for (const std::size_t face : list) output.print("{}\n", result_.faces[face].flipped ? 1 : 0);
      output.print(")\n;\n}}\n");
    }
    output.print(")\n");
    output.drain();
  }

  const MixedMesh& mesh_;
  const MeshWriting& writing_;
  OutputFolder& folder_;
  GroupNamings names_;
  std::vector<std::string> surface_names_, region_names_;
  std::vector<Face> faces_;  // of the cells, until result_ has them
  PolyhedralMesh result_;
  std::int64_t inside_ = 0;
};

}  // namespace

std::unique_ptr<OutputFolder> open_poly_mesh(const std::string& path) {
  const std::vector<std::string_view> own{"points",
                                          "faces",
                                          "owner",
                                          "neighbour",
                                          "boundary",
                                          "cellZones",
                                          "faceZones",
                                          "pointZones",
                                          "sets",
                                          "meshModifiers",
                                          "cellLevel",
                                          "pointLevel",
                                          "level0Edge",
                                          "surfaceIndex",
                                          "cellProcAddressing",
                                          "faceProcAddressing",
                                          "pointProcAddressing",
                                          "boundaryProcAddressing"};
  return std::make_unique<OutputFolder>(path, own);
}

void write_openfoam(const MixedMesh& mesh, const MeshWriting& writing, OutputFolder& folder) {
  PolyMesh(mesh, writing, folder).write();
}

}  // namespace hexpipe::formats
