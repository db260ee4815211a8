#include "common/mesh/mesh_part.hpp"

#include <fmt/format.h>

#include <bit>
#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/run/error.hpp"

namespace hexpipe {
namespace {

// Multiplication and shifts mix each word into all bits. This detects mistakes, not attacks.
class Checksum {
 public:
  void add(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x9e3779b97f4a7c15u;
    state_ ^= state_ >> 29;
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0x243f6a8885a308d3u;
};

void check_size(const char* source, const char* what, std::size_t wanted, std::size_t found) {
  if (wanted != found) throw DataError::at(source, "expected {} {} of the part, found {}", wanted, what, found);
}

void check_numbers(const char* source, const char* what, std::span<const std::int64_t> numbers, std::int64_t bound) {
  std::int64_t last = -1;
  for (const std::int64_t number : numbers) {
    if (number <= last || number >= bound)
      throw DataError::at(source, "expected ascending numbers of {} below {}, found {} after {}", what, bound, number,
                          last);
    last = number;
  }
}

void check_owners(const char* source, const char* what, std::span<const std::int32_t> owners, std::int32_t parts) {
  for (const std::int32_t owner : owners)
    if (owner < 0 || owner >= parts)
      throw DataError::at(source, "expected owners of {} below {}, found {}", what, parts, owner);
}

std::uint64_t kind_code(CellKind kind) {
  return kind == CellKind::hex ? 0 : kind == CellKind::prism ? 1 : 2;
}

Vertex first_vertex(const Candidates& candidates, std::size_t i) {
  return candidates.vertices[i][0];
}

}  // namespace

MeshFingerprint fingerprint_of(const TetMesh& mesh) {
  Checksum sum;
  for (const Vec3& p : mesh.points)
    for (const double x : {p.x, p.y, p.z}) sum.add(std::bit_cast<std::uint64_t>(x));
  const auto add_rows = [&](const auto& rows, const std::vector<std::int32_t>& tags) {
    for (const auto& row : rows)
      for (const Vertex v : row) sum.add(static_cast<std::uint32_t>(v));
    for (const std::int32_t tag : tags) sum.add(static_cast<std::uint32_t>(tag));
  };
  add_rows(mesh.tets, mesh.tet_tags);
  add_rows(mesh.triangles, mesh.triangle_tags);
  if (mesh.ridges) add_rows(*mesh.ridges, {});
  return {static_cast<std::int64_t>(mesh.points.size()), static_cast<std::int64_t>(mesh.tets.size()),
          static_cast<std::int64_t>(mesh.triangles.size()), sum.value()};
}

void validate(const MeshPart& part, const char* source) {
  if (part.parts < 1 || part.part < 0 || part.part >= part.parts)
    throw DataError::at(source, "expected a part below {}, found {}", part.parts, part.part);
  check_size(source, "owners of points", part.point_number.size(), part.point_part.size());
  check_size(source, "owners of tets", part.tet_number.size(), part.tet_part.size());
  if (!part.tet_turned.empty()) check_size(source, "turns of tets", part.tet_number.size(), part.tet_turned.size());
  check_numbers(source, "points", part.point_number, part.whole.points);
  check_numbers(source, "tets", part.tet_number, part.whole.tets);
  check_numbers(source, "triangles", part.triangle_number, part.whole.triangles);
  check_owners(source, "points", part.point_part, part.parts);
  check_owners(source, "tets", part.tet_part, part.parts);
  check_owners(source, "neighbours", part.neighbours, part.parts);
}

void validate_against(const MeshPart& part, const TetMesh& mesh, const char* source) {
  check_size(source, "numbers of points", mesh.points.size(), part.point_number.size());
  check_size(source, "numbers of tets", mesh.tets.size(), part.tet_number.size());
  check_size(source, "numbers of triangles", mesh.triangles.size(), part.triangle_number.size());
}

void validate_against(const MeshPart& part, const Candidates& candidates, const char* source) {
  const auto check = [&](const char* what, std::int32_t item, std::size_t bound) {
    if (item >= static_cast<std::int64_t>(bound))
      throw DataError::at(source, "expected candidates of {} below {}, found {}", what, bound, item);
  };
  for (const auto& row : candidates.vertices)
    for (const Vertex v : row) check("points", v, part.point_number.size());
  for (const TetIndex tet : candidates.tets) check("tets", tet, part.tet_number.size());
  for (const TetIndex tet : candidates.boundary_tets) check("tets", tet, part.tet_number.size());
}

CandidateKeys select(const CandidateKeys& keys, std::span<const CandidateIndex> kept) {
  CandidateKeys chosen;
  chosen.key.reserve(kept.size());
  chosen.part.reserve(kept.size());
  for (const CandidateIndex i : kept) {
    chosen.key.push_back(keys.key[i]);
    chosen.part.push_back(keys.part[i]);
  }
  return chosen;
}

std::string title_of(const MeshPart& part) {
  return fmt::format("part {} of {}", part.part, part.parts);
}

CandidateKeys keys_of_own(const Candidates& candidates, const MeshPart& part, const char* source) {
  CandidateKeys keys{std::vector<std::uint64_t>(candidates.size()),
                     std::vector<std::int32_t>(candidates.size(), part.part)};
  std::uint64_t place = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Vertex first = first_vertex(candidates, i);
    const bool is_next =
        i > 0 && candidates.kind[i] == candidates.kind[i - 1] && first == first_vertex(candidates, i - 1);
    place = is_next ? place + 1 : 0;
    const auto vertex = static_cast<std::uint64_t>(part.point_number[first]);
    if (place >> key_place_bits != 0 || vertex >> key_vertex_bits != 0)
      throw DataError::at(source, "expected fewer than 2^{} candidates at one vertex, found more at vertex {}",
                          key_place_bits, vertex);
    keys.key[i] =
        kind_code(candidates.kind[i]) << (key_place_bits + key_vertex_bits) | vertex << key_place_bits | place;
  }
  return keys;
}

void validate(const CandidateKeys& keys, std::size_t count, const char* source) {
  check_size(source, "candidate keys", count, keys.key.size());
  check_size(source, "candidate owners", count, keys.part.size());
  for (std::size_t i = 1; i < keys.key.size(); ++i)
    if (keys.key[i] <= keys.key[i - 1])
      throw DataError::at(source, "expected ascending keys of candidates, found {} after {}", keys.key[i],
                          keys.key[i - 1]);
}

}  // namespace hexpipe
