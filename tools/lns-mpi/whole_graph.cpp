#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "common/mwis/ground/target_weight.hpp"
#include "formats/pipeline/quads_of_choice.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/lns-mpi/source.hpp"

namespace hexpipe::lns_mpi {
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

// Regions are large enough to give the search room, and as many as a small machine has processors.
std::int32_t usual_blocks(std::int64_t vertices) {
  constexpr std::int64_t least = 4, most = 1 << 20, vertices_a_block = 50000;
  return static_cast<std::int32_t>(std::clamp(vertices / vertices_a_block, least, most));
}

// For the first rank: sends the others their rows and returns its own. The numbers of the vertices are their keys.
OwnedRows scatter_rows(Ranks& ranks, const BlockOwners& owners, const graph::ConflictGraph& graph,
                       const graph::IndependentSet& solution, const std::vector<std::int32_t>& blocks) {
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

// For the other ranks.
OwnedRows receive_rows(Ranks& ranks) {
  const Bytes bytes = ranks.receive(0);
  OwnedRows rows;
  rows.offsets.clear();
  Unpacker unpacker(bytes);
  visit_arrays(rows, [&](auto& values) { unpacker.get_all(values); });
  return rows;
}

// The first rank gets the whole solution, the others nothing.
graph::IndependentSet gather_solution(Ranks& ranks, const LocalGraph& local) {
  Packer packer;
  for (std::int32_t v = 0; v < local.vertex_count(); ++v)
    if (local.chosen[v] != 0 && local.owns(v)) packer.put(static_cast<std::int32_t>(local.keys[v]));
  std::vector<Bytes> to(static_cast<std::size_t>(ranks.count()));
  to[0] = packer.take();
  graph::IndependentSet solution;
  for (const Bytes& bytes : ranks.all_to_all(std::move(to)))
    for (Unpacker unpacker(bytes); !unpacker.at_end();) solution.push_back(unpacker.get<std::int32_t>());
  std::ranges::sort(solution);
  return solution;
}

// The value that is sent for it; a bound is never negative.
constexpr std::int64_t unknown_bound = -1;

class WholeGraph : public Source {
 public:
  WholeGraph(const RunContext& context, std::int32_t blocks) : context_(context) { blocks_ = blocks; }

  OwnedRows read(Ranks& ranks) override {
    pipeline::StageData data;
    std::vector<std::int32_t> cut;
    ranks.together([&] {
      if (!ranks.is_first()) return;
      stage_.emplace(context_);
      data = stage_->read({.needs = {Role::graph, Role::solution}});
      if (blocks_ == 0) blocks_ = choose_blocks(data.graph->vertex_count(), ranks.count());
      if (blocks_ < ranks.count())
        throw DataError(
            fmt::format("expected at least a block for each of {} ranks, found {}", ranks.count(), blocks_));
      cut = cut_into_blocks(*data.graph, blocks_);
      if (!context_.streams.files.contains(Role::graph)) bound_ = mwis::ground::bound_in(data.history);
      if (data.quads) {
        candidates_ = static_cast<std::uint64_t>(data.graph->vertex_count() - pipeline::quad_count(data));
        weight_of_quads_ = pipeline::weight_of_quads(data);
      }
    });
    Packer packer;
    packer.put(blocks_);
    packer.put(bound_.value_or(unknown_bound));
    packer.put(candidates_);
    packer.put(weight_of_quads_);
    Bytes facts = packer.take();
    ranks.broadcast(facts);
    Unpacker unpacker(facts);
    blocks_ = unpacker.get<std::int32_t>();
    if (const auto bound = unpacker.get<std::int64_t>(); bound != unknown_bound) bound_ = bound;
    candidates_ = unpacker.get<std::uint64_t>();
    weight_of_quads_ = unpacker.get<std::int64_t>();
    if (!ranks.is_first()) return receive_rows(ranks);
    return scatter_rows(ranks, BlockOwners(blocks_, ranks.count()), *data.graph, *data.solution, cut);
  }

  void write(Ranks& ranks, const LocalGraph& local, const nlohmann::ordered_json& details) override {
    const pipeline::SolutionProduct product{gather_solution(ranks, local)};
    ranks.together([&] {
      if (ranks.is_first()) stage_->write(product, details);
    });
  }

 private:
  // Under a limit of iterations, the result must not depend on the number of ranks. Otherwise each rank gets as many as
  // the others.
  std::int32_t choose_blocks(std::int64_t vertices, std::int32_t ranks) const {
    const std::int32_t usual = usual_blocks(vertices);
    return context_.common.iterations ? usual : (usual + ranks - 1) / ranks * ranks;
  }

  RunContext context_;
  std::optional<pipeline::Stage> stage_;
};

}  // namespace

std::unique_ptr<Source> whole_graph(const RunContext& context, std::int32_t blocks) {
  return std::make_unique<WholeGraph>(context, blocks);
}

}  // namespace hexpipe::lns_mpi
