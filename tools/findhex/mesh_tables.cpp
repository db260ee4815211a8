#include "tools/findhex/mesh_tables.hpp"

#include <algorithm>
#include <array>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/orientation.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe {
namespace {

constexpr std::int64_t tets_a_block = 4096;
constexpr std::int32_t derived_tag = 0;

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

// Surface triangles by their vertices, with their tags in a list of the distinct ones.
class TagFinder {
 public:
  explicit TagFinder(const TetMesh& mesh) : tags_(mesh.triangle_tags) {
    std::sort(tags_.begin(), tags_.end());
    tags_.erase(std::unique(tags_.begin(), tags_.end()), tags_.end());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      entries_.push_back({sorted(mesh.triangles[i]), mesh.triangle_tags[i]});
    std::sort(entries_.begin(), entries_.end());
  }

  // 0 where no triangle is, else 1 or greater.
  std::int32_t number_of_tag(const Triangle& triangle) const {
    const Triangle key = sorted(triangle);
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), key,
                                     [](const Entry& entry, const Triangle& wanted) { return entry.first < wanted; });
    if (at == entries_.end() || at->first != key) return 0;
    return static_cast<std::int32_t>(std::lower_bound(tags_.begin(), tags_.end(), at->second) - tags_.begin()) + 1;
  }

 private:
  using Entry = std::pair<Triangle, std::int32_t>;
  std::vector<std::int32_t> tags_;
  std::vector<Entry> entries_;
};

}  // namespace

MeshTables::MeshTables(TetMesh mesh, const char* source)
    : mesh_(std::move(mesh)),
      usable_(judge_tets(source)),
      adjacency_(mesh_, source),
      facets_(mesh_, adjacency_, usable_),
      facet_labels_(label_facets()) {}

std::vector<bool> MeshTables::judge_tets(const char* source) {
  findings_.orientation = orient_tets(mesh_, source);
  const std::vector<std::int8_t>& signs = findings_.orientation.signs;
  std::vector<bool> usable(signs.size());
  for (std::size_t t = 0; t < usable.size(); ++t) usable[t] = signs[t] > 0;
  return usable;
}

std::vector<std::int32_t> MeshTables::label_facets() {
  findings_.derived_triangles =
      static_cast<std::int64_t>(add_missing_boundary_triangles(mesh_, adjacency_, derived_tag));
  const TagFinder finder(mesh_);
  std::vector<std::int32_t> labels(4 * mesh_.tets.size());
  parallel_for(static_cast<std::int64_t>(mesh_.tets.size()), tets_a_block, [&](std::int64_t t) {
    const Tet& tet = mesh_.tets[t];
    for (int facet = 0; facet < 4; ++facet) {
      const LocalTriangle& c = TetTopology::triangles[facet];
      const bool inside = adjacency_.tet_beyond(static_cast<std::int32_t>(t), facet) != TetAdjacency::none;
      const std::int32_t tag = finder.number_of_tag({tet[c[0]], tet[c[1]], tet[c[2]]});
      labels[4 * t + facet] = tag == 0 ? 0 : 2 * tag + (inside ? 1 : 0);
    }
  });
  return labels;
}

}  // namespace hexpipe
