#include "tools/tetmesh/search/judged_mesh.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/quality.hpp"
#include "tools/tetmesh/search/hex_choice.hpp"

namespace hexpipe::tetmesh::search {
namespace {

// A share of a hex's volume, for each open quad. After the hexes of simp have grown, each open quad leaves a seventh of
// a hex uncovered, and a quarter of what the choice had left stays uncovered. After 400 rounds hexes had 95.6, 95.8 and
// 95.9 % of simp at 0.07, 0.2 and 0.4, and after 80 rounds 91.8 and 92.2 % of blub at 0.07 and 0.2.
constexpr double price_of_open_quad = 0.2;

Quad quad_of(const ChosenHex& hex, const LocalQuad& local) {
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) quad[i] = hex.corners[local[i]];
  return quad;
}

}  // namespace

double JudgedMesh::hex_volume() const {
  double volume = 0;
  for (const ChosenHex& hex : hexes) volume += hex.volume;
  return volume;
}

double JudgedMesh::total_worth() const {
  double total = 0;
  for (const double w : worth) total += w;
  return total;
}

JudgedMesh judge(tetgen::BuiltMesh built, std::vector<ChosenHex> hexes) {
  JudgedMesh judged{std::move(built), std::move(hexes), {}, {}, {}, {}};
  const TetMesh& mesh = judged.built.mesh;
  judged.hex_of_tet.assign(mesh.tets.size(), no_index);
  KeySet<3> boundary;
  for (const Triangle& triangle : mesh.triangles) boundary.insert(key_of(triangle));
  KeyMap<4, int> hexes_on;
  for (std::size_t h = 0; h < judged.hexes.size(); ++h) {
    for (const auto* tets : {&judged.hexes[h].interior_tets, &judged.hexes[h].boundary_tets})
      for (const TetIndex t : *tets) judged.hex_of_tet[t] = static_cast<std::int32_t>(h);
    for (const LocalQuad& local : HexTopology::quads) ++hexes_on[key_of(quad_of(judged.hexes[h], local))];
  }
  for (const auto t : indices<TetIndex>(mesh.tets.size()))
    if (judged.hex_of_tet[t] == no_index) judged.left.push_back(t);
  for (const ChosenHex& hex : judged.hexes) {
    int open = 0;
    for (const LocalQuad& local : HexTopology::quads) {
      const Quad quad = quad_of(hex, local);
      open += hexes_on.at(key_of(quad)) == 1 && !is_on(boundary, quad);
    }
    Vec3 middle{};
    for (const Vertex v : hex.corners) middle = middle + mesh.points[v];
    judged.middles.push_back(0.125 * middle);
    judged.worth.push_back((1 - price_of_open_quad * open) * hex.volume);
  }
  return judged;
}

}  // namespace hexpipe::tetmesh::search
