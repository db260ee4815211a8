#include "common/mesh/candidates.hpp"

#include <algorithm>
#include <cmath>

#include "common/run/error.hpp"
#include "common/run/memory.hpp"

namespace hexpipe {
namespace {

void check_length(const char* source, const char* what, std::size_t expected, std::size_t found) {
  if (found != expected) throw DataError::at(source, "expected {} {}, found {}", expected, what, found);
}

void check_kind_and_corners(const Candidates& candidates, std::size_t i, const char* source) {
  const CellKind kind = candidates.kind[i];
  if (kind != CellKind::hex && kind != CellKind::prism && kind != CellKind::pyramid)
    throw DataError::at(source, "expected kind 12, 13 or 14 of candidate {}, found {}", i + 1, static_cast<int>(kind));
  const auto corners = candidates.corners_of(i);
  for (std::size_t c = 0; c < 8; ++c) {
    const Vertex v = candidates.vertices[i][c];
    if (c >= corners.size() && v != no_index)
      throw DataError::at(source, "expected -1 after the {} vertices of candidate {}, found {}", corners.size(), i + 1,
                          v);
    if (c < corners.size() && v < 0)
      throw DataError::at(source, "expected {} vertices of candidate {}, found {}", corners.size(), i + 1, v);
    if (c < corners.size() && std::find(corners.begin(), corners.begin() + c, v) != corners.begin() + c)
      throw DataError::at(source, "expected different vertices of candidate {}, found {} twice", i + 1, v);
  }
  if (!std::isfinite(candidates.quality[i]))
    throw DataError::at(source, "expected a finite quality of candidate {}, found {}", i + 1, candidates.quality[i]);
  if (!std::isfinite(candidates.volume[i]))
    throw DataError::at(source, "expected a finite volume of candidate {}, found {}", i + 1, candidates.volume[i]);
}

// `what`: "tets" or "boundary tets".
void check_tets(std::size_t count, const std::vector<std::int64_t>& offsets, const std::vector<TetIndex>& tets,
                const char* what, const char* source) {
  if (offsets.size() != count + 1)
    throw DataError::at(source, "expected {} offsets of {}, found {}", count + 1, what, offsets.size());
  if (offsets.front() != 0)
    throw DataError::at(source, "expected offsets of {} from 0, found {}", what, offsets.front());
  if (!std::is_sorted(offsets.begin(), offsets.end()))
    throw DataError::at(source, "expected ascending offsets of {}", what);
  if (offsets.back() != static_cast<std::int64_t>(tets.size()))
    throw DataError::at(source, "expected offsets of {} up to {}, found {}", what, tets.size(), offsets.back());
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = tets.begin() + offsets[i], end = tets.begin() + offsets[i + 1];
    if (begin != end && *begin < 0)
      throw DataError::at(source, "expected {} of candidate {}, found {}", what, i + 1, *begin);
    if (std::adjacent_find(begin, end, std::greater_equal<>()) != end)
      throw DataError::at(source, "expected ascending {} of candidate {}", what, i + 1);
  }
}

void check_against_mesh(const std::vector<std::int64_t>& offsets, const std::vector<TetIndex>& tets,
                        const TetMesh& mesh, std::size_t i, const char* source) {
  // The tets ascend, so the last one is the largest.
  if (offsets[i] == offsets[i + 1]) return;
  const TetIndex last = tets[offsets[i + 1] - 1];
  if (static_cast<std::size_t>(last) >= mesh.tets.size())
    throw DataError::at(source, "expected tets below {} in candidate {}, found {}", mesh.tets.size(), i + 1, last);
}

// Reserves room for the final size, estimated from what is there so far, and a little more.
template <class T>
void make_room(std::vector<T>& items, std::size_t added, double share_of_all) {
  const std::size_t wanted = items.size() + added;
  if (wanted <= items.capacity()) return;
  constexpr double margin = 1.05;
  // An estimate enlarges the memory at most eightfold.
  const double whole = std::min(share_of_all < 1 ? margin / share_of_all : 1.0, 8.0) * static_cast<double>(wanted);
  reserve_in_huge_pages(items, std::max(wanted, static_cast<std::size_t>(whole)));
}

template <class T>
void append_items(std::vector<T>& to, const std::vector<T>& from, double share_of_all) {
  make_room(to, from.size(), share_of_all);
  to.insert(to.end(), from.begin(), from.end());
}

void append_offsets(std::vector<std::int64_t>& to, const std::vector<std::int64_t>& from, double share_of_all) {
  make_room(to, from.size() - 1, share_of_all);
  const std::int64_t base = to.back();
  for (std::size_t i = 1; i < from.size(); ++i) to.push_back(base + from[i]);
}

}  // namespace

void append(Candidates& to, const Candidates& from, double share_of_all) {
  append_items(to.vertices, from.vertices, share_of_all);
  append_items(to.kind, from.kind, share_of_all);
  append_items(to.quality, from.quality, share_of_all);
  append_items(to.volume, from.volume, share_of_all);
  append_items(to.tets, from.tets, share_of_all);
  append_offsets(to.tet_offsets, from.tet_offsets, share_of_all);
  append_items(to.boundary_tets, from.boundary_tets, share_of_all);
  append_offsets(to.boundary_tet_offsets, from.boundary_tet_offsets, share_of_all);
}

Candidates select(const Candidates& candidates, std::span<const CandidateIndex> kept) {
  const auto same = [](auto number) { return number; };
  Candidates chosen;
  for (const CandidateIndex i : kept) append_candidate(chosen, candidates, i, same, same, same);
  return chosen;
}

void validate(const Candidates& candidates, const char* source) {
  const std::size_t count = candidates.kind.size();
  check_length(source, "rows of vertices", count, candidates.vertices.size());
  check_length(source, "qualities", count, candidates.quality.size());
  check_length(source, "volumes", count, candidates.volume.size());
  for (std::size_t i = 0; i < count; ++i) check_kind_and_corners(candidates, i, source);
  check_tets(count, candidates.tet_offsets, candidates.tets, "tets", source);
  check_tets(count, candidates.boundary_tet_offsets, candidates.boundary_tets, "boundary tets", source);
}

void validate_against(const Candidates& candidates, const TetMesh& mesh, const char* source) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (const Vertex v : candidates.corners_of(i))
      if (static_cast<std::size_t>(v) >= mesh.points.size())
        throw DataError::at(source, "expected vertices below {} in candidate {}, found {}", mesh.points.size(), i + 1,
                            v);
    check_against_mesh(candidates.tet_offsets, candidates.tets, mesh, i, source);
    check_against_mesh(candidates.boundary_tet_offsets, candidates.boundary_tets, mesh, i, source);
  }
}

}  // namespace hexpipe
