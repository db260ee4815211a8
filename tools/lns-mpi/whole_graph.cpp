#include "tools/lns-mpi/whole_graph.hpp"

#include <algorithm>

namespace hexpipe {
namespace {

template <class Rows, class Visit>
void visit_arrays(Rows& rows, Visit&& visit) {
  visit(rows.keys), visit(rows.blocks), visit(rows.weights), visit(rows.chosen), visit(rows.offsets);
  visit(rows.neighbours), visit(rows.neighbour_blocks);
}

Bytes pack(const OwnedRows& rows) {
  Packer packer;
  visit_arrays(rows, [&]<class T>(const std::vector<T>& values) { packer.put_all(std::span<const T>(values)); });
  return packer.take();
}

}  // namespace

OwnedRows scatter_rows(Ranks& ranks, const BlockOwners& owners, const ConflictGraph& graph,
                       const IndependentSet& solution, const std::vector<std::int32_t>& blocks) {
  std::vector<std::uint8_t> chosen(graph.weights.size(), 0);
  for (const std::int32_t v : solution) chosen[v] = 1;
  const auto rows_of = [&](int rank) {
    OwnedRows rows;
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
      if (owners.rank_of(blocks[v]) != rank) continue;
      rows.keys.push_back(static_cast<std::uint64_t>(v));
      rows.blocks.push_back(blocks[v]);
      rows.weights.push_back(graph.weights[v]);
      rows.chosen.push_back(chosen[v]);
      for (const std::int32_t u : graph.neighbours_of(v)) {
        rows.neighbours.push_back(static_cast<std::uint64_t>(u));
        rows.neighbour_blocks.push_back(blocks[u]);
      }
      rows.offsets.push_back(static_cast<std::int64_t>(rows.neighbours.size()));
    }
    return rows;
  };
  for (int r = 1; r < ranks.count(); ++r) ranks.send(r, pack(rows_of(r)));
  return rows_of(0);
}

OwnedRows receive_rows(Ranks& ranks) {
  const Bytes bytes = ranks.receive(0);
  OwnedRows rows;
  rows.offsets.clear();
  Unpacker unpacker(bytes);
  visit_arrays(rows, [&](auto& values) { unpacker.get_all(values); });
  return rows;
}

IndependentSet gather_solution(Ranks& ranks, const Piece& piece) {
  Packer packer;
  for (std::int32_t v = 0; v < piece.vertex_count(); ++v)
    if (piece.chosen[v] != 0 && piece.owns(v)) packer.put(static_cast<std::int32_t>(piece.keys[v]));
  std::vector<Bytes> to(static_cast<std::size_t>(ranks.count()));
  to[0] = packer.take();
  IndependentSet solution;
  for (const Bytes& bytes : ranks.exchange(std::move(to)))
    for (Unpacker unpacker(bytes); !unpacker.at_end();) solution.push_back(unpacker.get<std::int32_t>());
  std::ranges::sort(solution);
  return solution;
}

}  // namespace hexpipe
