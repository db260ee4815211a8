#include "common/mesh/orientation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/validity.hpp"
#include "common/run/error.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe {
namespace {

constexpr std::int64_t tets_a_block = 4096;

std::int8_t sign_of(const TetMesh& mesh, std::int64_t t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  return static_cast<std::int8_t>(orientation(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]));
}

std::vector<std::int8_t> signs_of(const TetMesh& mesh) {
  std::vector<std::int8_t> signs(mesh.tets.size());
  parallel_for(static_cast<std::int64_t>(signs.size()), tets_a_block,
               [&](std::int64_t t) { signs[t] = sign_of(mesh, t); });
  return signs;
}

// The facet opposite corner i of a tet, beginning with its lowest vertex, in the sense of TetTopology::triangles.
Triangle facet_from_lowest(const Tet& tet, int facet) {
  const LocalTriangle& c = TetTopology::triangles[facet];
  Triangle triangle{tet[c[0]], tet[c[1]], tet[c[2]]};
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

// Two tets at a facet are listed in the same sense if they list the facet in opposite senses.
bool listed_alike(const Tet& tet, int facet, const Tet& other) {
  const Triangle triangle = facet_from_lowest(tet, facet);
  for (int i = 0; i < 4; ++i) {
    if (std::find(triangle.begin(), triangle.end(), other[i]) == triangle.end())
      return facet_from_lowest(other, i) != triangle;
  }
  return true;
}

enum class Turn : std::int8_t { unknown, keep, turn };

// Decides for all tets that are connected to `start` by facets; puts them into `component`.
void spread(const TetMesh& mesh, const TetAdjacency& adjacency, TetIndex start, std::vector<Turn>& turns,
            std::vector<TetIndex>& component) {
  turns[start] = Turn::keep;
  component.assign(1, start);
  for (std::size_t next = 0; next < component.size(); ++next) {
    const TetIndex tet = component[next];
    for (int facet = 0; facet < 4; ++facet) {
      const TetIndex beyond = adjacency.tet_beyond(tet, facet);
      if (beyond == no_index || turns[beyond] != Turn::unknown) continue;
      const bool alike = listed_alike(mesh.tets[tet], facet, mesh.tets[beyond]);
      turns[beyond] = alike == (turns[tet] == Turn::keep) ? Turn::keep : Turn::turn;
      component.push_back(beyond);
    }
  }
}

// Chooses the sense in which more tets of the component are positive.
void prefer_positive(std::span<const TetIndex> component, const std::vector<std::int8_t>& signs,
                     std::vector<Turn>& turns) {
  std::int64_t balance = 0;
  for (const TetIndex t : component) balance += turns[t] == Turn::keep ? signs[t] : -signs[t];
  if (balance >= 0) return;
  for (const TetIndex t : component) turns[t] = turns[t] == Turn::keep ? Turn::turn : Turn::keep;
}

std::vector<std::int8_t> find_turns(const TetMesh& mesh, const std::vector<std::int8_t>& signs, const char* source) {
  const TetAdjacency adjacency(mesh, source);
  std::vector<Turn> turns(mesh.tets.size(), Turn::unknown);
  std::vector<TetIndex> component;
  for (const auto start : indices<TetIndex>(mesh.tets.size())) {
    if (turns[start] != Turn::unknown) continue;
    spread(mesh, adjacency, start, turns, component);
    prefer_positive(component, signs, turns);
  }
  std::vector<std::int8_t> turned(turns.size());
  for (std::size_t t = 0; t < turns.size(); ++t) turned[t] = turns[t] == Turn::turn ? 1 : 0;
  return turned;
}

// An empty `turns` turns none.
TetOrientation turn_tets(TetMesh& mesh, std::vector<std::int8_t> signs, std::vector<std::int8_t> turns) {
  TetOrientation result{.signs = std::move(signs), .turns = std::move(turns)};
  for (std::size_t t = 0; t < result.turns.size(); ++t) {
    if (result.turns[t] == 0) continue;
    std::swap(mesh.tets[t][2], mesh.tets[t][3]);
    result.signs[t] = static_cast<std::int8_t>(-result.signs[t]);
    ++result.turned;
  }
  result.inverted = std::count(result.signs.begin(), result.signs.end(), -1);
  result.flat = std::count(result.signs.begin(), result.signs.end(), 0);
  return result;
}

}  // namespace

TetOrientation orient_tets(TetMesh& mesh, const char* source) {
  std::vector<std::int8_t> signs = signs_of(mesh), turns;
  if (std::find(signs.begin(), signs.end(), -1) != signs.end()) turns = find_turns(mesh, signs, source);
  return turn_tets(mesh, std::move(signs), std::move(turns));
}

TetOrientation orient_tets(TetMesh& mesh, std::vector<std::int8_t> turns) {
  return turn_tets(mesh, signs_of(mesh), std::move(turns));
}

void check_sides(const TetMesh& mesh, const TetAdjacency& adjacency, const char* source,
                 std::span<const TetIndex> numbers) {
  const auto number_of = [&](std::int64_t tet) { return numbers.empty() ? tet : numbers[tet]; };
  parallel_for(static_cast<std::int64_t>(mesh.tets.size()), tets_a_block, [&](std::int64_t t) {
    const auto across = adjacency.tets_beyond(TetIndex(t));
    for (int facet = 0; facet < 4; ++facet) {
      const TetIndex beyond = across[facet];
      if (beyond <= t || listed_alike(mesh.tets[t], facet, mesh.tets[beyond])) continue;
      if (sign_of(mesh, t) <= 0 || sign_of(mesh, beyond) <= 0) continue;
      const auto [first, second] = std::minmax({number_of(t), number_of(beyond)});
      const auto& [a, b, c] = facet_from_lowest(mesh.tets[t], facet);
      throw DataError::at(source,
                          "expected tets on the two sides of a facet, found tets {} and {} on one side of that at "
                          "vertices {} {} {}",
                          first + 1, second + 1, a + 1, b + 1, c + 1);
    }
  });
}

std::optional<std::string> turned_tets_warning(const TetOrientation& orientation) {
  constexpr std::int64_t one_in = 4;
  const auto count = static_cast<std::int64_t>(orientation.signs.size());
  if (orientation.turned == 0 || one_in * orientation.turned > count) return std::nullopt;
  return fmt::format("{} of {} tets listed inside out, unlike their neighbours: turned", orientation.turned, count);
}

}  // namespace hexpipe
