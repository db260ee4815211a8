#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/mesh/mesh_part.hpp"
#include "common/mesh/orientation.hpp"
#include "common/mesh/submesh.hpp"
#include "common/run/error.hpp"
#include "tests/unit/findhex_meshes.hpp"

namespace hexpipe {
namespace {

using hexpipe::testing::kuhn_lattice;

Candidates pyramids_from(const std::vector<Vertex>& first) {
  Candidates candidates;
  for (const Vertex v : first) {
    candidates.vertices.push_back({v, 11, 12, 13, 14, -1, -1, -1});
    candidates.kind.push_back(CellKind::pyramid);
  }
  return candidates;
}

TEST(MeshPart, KeysOrderByKindThenVertexThenPlace) {
  MeshPart part;
  part.part = 3;
  for (std::int64_t i = 0; i < 20; ++i) part.point_number.push_back(10 * i);
  Candidates candidates = pyramids_from({2, 2, 5});
  candidates.kind = {CellKind::hex, CellKind::prism, CellKind::prism};
  candidates.vertices.push_back(candidates.vertices.back());
  candidates.kind.push_back(CellKind::prism);
  const CandidateKeys keys = keys_of_own(candidates, part, "test");
  const std::uint64_t prism = std::uint64_t{1} << 62;
  EXPECT_EQ(keys.key, (std::vector<std::uint64_t>{20 << 24, prism | 20 << 24, prism | 50 << 24, prism | 50 << 24 | 1}));
  EXPECT_EQ(keys.part, (std::vector<std::int32_t>{3, 3, 3, 3}));
  EXPECT_NO_THROW(validate(keys, 4, "test"));
}

TEST(MeshPart, KeysThatDoNotFitAreRefused) {
  MeshPart part;
  part.point_number = {std::int64_t{1} << key_vertex_bits};
  EXPECT_THROW(keys_of_own(pyramids_from({0}), part, "test"), DataError);
}

TEST(MeshPart, KeysHaveToAscend) {
  EXPECT_THROW(validate(CandidateKeys{{5, 5}, {0, 0}}, 2, "test"), DataError);
  EXPECT_THROW(validate(CandidateKeys{{5, 4}, {0, 0}}, 2, "test"), DataError);
  EXPECT_THROW(validate(CandidateKeys{{5, 6}, {0}}, 2, "test"), DataError);
  EXPECT_THROW(validate(CandidateKeys{{5, 6}, {0, 0}}, 3, "test"), DataError);
}

TEST(MeshPart, NumbersHaveToAscendAndOwnersToExist) {
  MeshPart good;
  good.part = 1;
  good.parts = 2;
  good.whole = {10, 10, 10, 0};
  good.point_number = {2, 4};
  good.point_part = {0, 1};
  EXPECT_NO_THROW(validate(good, "test"));
  MeshPart bad = good;
  bad.point_number = {4, 4};
  EXPECT_THROW(validate(bad, "test"), DataError);
  bad = good;
  bad.point_number = {4, 10};
  EXPECT_THROW(validate(bad, "test"), DataError);
  bad = good;
  bad.point_part = {0, 2};
  EXPECT_THROW(validate(bad, "test"), DataError);
  bad = good;
  bad.point_part = {0};
  EXPECT_THROW(validate(bad, "test"), DataError);
  bad = good;
  bad.neighbours = {2};
  EXPECT_THROW(validate(bad, "test"), DataError);
  bad = good;
  bad.part = 2;
  EXPECT_THROW(validate(bad, "test"), DataError);
}

TEST(MeshPart, FingerprintTellsMeshesApart) {
  const TetMesh mesh = kuhn_lattice(2);
  TetMesh other = mesh;
  EXPECT_EQ(fingerprint_of(mesh), fingerprint_of(other));
  other.points[3].x += 1e-12;
  EXPECT_NE(fingerprint_of(mesh), fingerprint_of(other));
  other = mesh;
  other.tet_tags[5] = 7;
  EXPECT_NE(fingerprint_of(mesh), fingerprint_of(other));
  other = mesh;
  std::swap(other.tets[0], other.tets[1]);
  EXPECT_NE(fingerprint_of(mesh), fingerprint_of(other));
}

TEST(Submesh, TetsAroundMarkedPointsInTheirOrder) {
  const TetMesh mesh = kuhn_lattice(4);
  std::vector<bool> marked(mesh.points.size());
  marked[0] = true;
  for (int edges = 0; edges < 3; ++edges) {
    // By distances in the mesh, one round of all tets after another.
    std::vector<int> distance(mesh.points.size(), 99);
    distance[0] = 0;
    for (int round = 0; round < 4; ++round)
      for (const Tet& tet : mesh.tets)
        for (const Vertex v : tet)
          for (const Vertex w : tet) distance[v] = std::min(distance[v], distance[w] + 1);
    std::vector<TetIndex> tets;
    for (const auto t : indices<TetIndex>(mesh.tets.size()))
      for (const Vertex v : mesh.tets[t])
        if (distance[v] <= edges) {
          tets.push_back(t);
          break;
        }
    const Submesh around = submesh_around(mesh, marked, edges);
    EXPECT_EQ(around.tets, tets);
    ASSERT_EQ(around.mesh.tets.size(), tets.size());
    for (std::size_t t = 0; t < tets.size(); ++t)
      for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(around.points[around.mesh.tets[t][i]], mesh.tets[tets[t]][i]);
  }
}

TEST(Orientation, KnownTurnsGiveTheSame) {
  TetMesh mesh = kuhn_lattice(2);
  for (std::size_t t = 0; t < mesh.tets.size(); t += 5) std::swap(mesh.tets[t][0], mesh.tets[t][1]);
  TetMesh again = mesh;
  const TetOrientation found = orient_tets(mesh, "test");
  EXPECT_GT(found.turned, 0);
  const TetOrientation known = orient_tets(again, found.turns);
  EXPECT_EQ(again, mesh);
  EXPECT_EQ(known.signs, found.signs);
  EXPECT_EQ(known.turned, found.turned);
}

}  // namespace
}  // namespace hexpipe
