#include "common/candidates/vertex_links.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/run/memory.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::candidates {
namespace {

constexpr std::int64_t linked_vertices_a_block = 1024;

// Calls visit(i, j) with the places of two neighbours of v, for each facet of a usable tet at v, in both directions.
// Facets between two tets come twice.
template <class Visit>
void for_each_link(const TetMesh& mesh, const TetAdjacency& adjacency, const std::vector<bool>& usable,
                   const VertexLinks& links, Vertex v, Visit&& visit) {
  for (const std::int32_t t : adjacency.tets_at(v)) {
    if (!usable[t]) continue;
    std::array<int, 3> places;
    std::size_t count = 0;
    for (const Vertex w : mesh.tets[t])
      if (w != v) places[count++] = links.place_of(w, v);
    for (std::size_t a = 0; a < 3; ++a) {
      visit(places[a], places[(a + 1) % 3]);
      visit(places[(a + 1) % 3], places[a]);
    }
  }
}

}  // namespace

VertexLinks::VertexLinks(const TetMesh& mesh, const TetAdjacency& adjacency, const std::vector<bool>& usable)
    : adjacency_(adjacency), slot_offsets_(mesh.points.size() + 1, 0) {
  resize_in_huge_pages(rows_, adjacency.neighbour_count());
  const auto vertex_count = static_cast<std::int64_t>(mesh.points.size());
  for (std::int64_t v = 0; v < vertex_count; ++v) {
    const std::size_t count = neighbours_of(static_cast<Vertex>(v)).size();
    const std::size_t slots = count <= most_narrow ? std::bit_ceil(2 * count + 1) : 0;
    slot_offsets_[v + 1] = slot_offsets_[v] + static_cast<std::int64_t>(slots);
  }
  resize_in_huge_pages(slots_, static_cast<std::size_t>(slot_offsets_.back()), no_place);
  parallel_for(vertex_count, linked_vertices_a_block, [&](std::int64_t v) {
    if (!is_narrow(static_cast<Vertex>(v))) return;
    file_places(static_cast<Vertex>(v));
    link_narrow(mesh, usable, static_cast<Vertex>(v));
  });
  for (std::int64_t v = 0; v < vertex_count; ++v)
    if (!is_narrow(static_cast<Vertex>(v))) link_wide(mesh, usable, static_cast<Vertex>(v));
}

void VertexLinks::file_places(Vertex v) {
  const auto neighbours = neighbours_of(v);
  const std::int64_t begin = slot_offsets_[v], mask = slot_offsets_[v + 1] - begin - 1;
  for (std::size_t place = 0; place < neighbours.size(); ++place) {
    std::int64_t slot = first_slot(neighbours[place]) & mask;
    while (slots_[begin + slot] != no_place) slot = (slot + 1) & mask;
    slots_[begin + slot] = static_cast<std::uint8_t>(place);
  }
}

void VertexLinks::link_narrow(const TetMesh& mesh, const std::vector<bool>& usable, Vertex v) {
  std::uint64_t* const rows = rows_.data() + adjacency_.first_neighbour_of(v);
  for_each_link(mesh, adjacency_, usable, *this, v, [&](int i, int j) { rows[i] |= std::uint64_t{1} << j; });
}

void VertexLinks::link_wide(const TetMesh& mesh, const std::vector<bool>& usable, Vertex v) {
  std::vector<std::pair<std::int32_t, std::int32_t>> links;
  for_each_link(mesh, adjacency_, usable, *this, v, [&](int i, int j) { links.emplace_back(i, j); });
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  auto next = links.begin();
  for (std::size_t i = 0; i < neighbours_of(v).size(); ++i) {
    rows_[adjacency_.first_neighbour_of(v) + i] = wide_offsets_.size() - 1;
    for (; next != links.end() && next->first == static_cast<std::int32_t>(i); ++next)
      wide_places_.push_back(next->second);
    wide_offsets_.push_back(static_cast<std::int64_t>(wide_places_.size()));
  }
}

std::span<const std::int32_t> VertexLinks::wide_row(Vertex v, int i) const {
  const std::uint64_t at = row(v, i);
  return std::span(wide_places_).subspan(wide_offsets_[at], wide_offsets_[at + 1] - wide_offsets_[at]);
}

std::vector<std::int32_t> VertexLinks::wide_within_two_links(Vertex v, int i, int first) const {
  const auto linked = wide_row(v, i);
  std::vector<std::int32_t> reached(linked.begin(), linked.end());
  for (const std::int32_t k : linked) {
    if (k < first) continue;
    const auto beyond = wide_row(v, k);
    reached.insert(reached.end(), beyond.begin(), beyond.end());
  }
  std::erase_if(reached, [i](std::int32_t place) { return place <= i; });
  std::sort(reached.begin(), reached.end());
  reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
  return reached;
}

int VertexLinks::place_among_many(Vertex w, std::span<const Vertex> neighbours) {
  const auto at = std::lower_bound(neighbours.begin(), neighbours.end(), w);
  return at != neighbours.end() && *at == w ? static_cast<int>(at - neighbours.begin()) : no_index;
}

bool VertexLinks::are_linked_among_many(Vertex v, int i, int j) const {
  const auto places = wide_row(v, i);
  return std::binary_search(places.begin(), places.end(), j);
}

bool VertexLinks::is_facet(Vertex a, Vertex b, Vertex c) const {
  const int i = place_of(b, a), j = place_of(c, a);
  return i != no_index && j != no_index && are_linked(a, i, j);
}

}  // namespace hexpipe::candidates
