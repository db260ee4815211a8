#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "formats/pipeline/stage.hpp"
#include "tools/lns-mpi/source.hpp"

namespace hexpipe::lns_mpi {
namespace {

// A part's own vertices with their rows.
void append_rows(const pipeline::StageData& part, OwnedRows& rows) {
  const graph::ConflictGraph& graph = *part.graph;
  const CandidateKeys& keys = *part.candidate_keys;
  std::vector<std::uint8_t> chosen(graph.weights.size(), 0);
  if (part.solution)
    for (const std::int32_t v : *part.solution) chosen[v] = 1;
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    if (keys.part[v] != part.part->part) continue;
    rows.keys.push_back(keys.key[v]);
    rows.blocks.push_back(keys.part[v]);
    rows.weights.push_back(graph.weights[v]);
    rows.chosen.push_back(chosen[v]);
    for (const std::int32_t u : graph.neighbours_of(v)) {
      rows.neighbours.push_back(keys.key[u]);
      rows.neighbour_blocks.push_back(keys.part[u]);
    }
    rows.offsets.push_back(static_cast<std::int64_t>(rows.neighbours.size()));
  }
}

// Sorts by keys: they ascend within each part, but not over several.
OwnedRows in_order(const OwnedRows& rows) {
  std::vector<std::size_t> order(rows.keys.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t i) { return rows.keys[i]; });
  OwnedRows sorted;
  for (const std::size_t i : order) {
    sorted.keys.push_back(rows.keys[i]);
    sorted.blocks.push_back(rows.blocks[i]);
    sorted.weights.push_back(rows.weights[i]);
    sorted.chosen.push_back(rows.chosen[i]);
    const auto begin = rows.offsets[i], end = rows.offsets[i + 1];
    sorted.neighbours.insert(sorted.neighbours.end(), rows.neighbours.begin() + begin, rows.neighbours.begin() + end);
    sorted.neighbour_blocks.insert(sorted.neighbour_blocks.end(), rows.neighbour_blocks.begin() + begin,
                                   rows.neighbour_blocks.begin() + end);
    sorted.offsets.push_back(static_cast<std::int64_t>(sorted.neighbours.size()));
  }
  return sorted;
}

class GraphParts : public Source {
 public:
  GraphParts(const RunContext& context, std::vector<std::string> files) : context_(context), files_(std::move(files)) {
    blocks_ = static_cast<std::int32_t>(files_.size());
  }

  OwnedRows read(Ranks& ranks) override {
    const BlockOwners owners(blocks_, ranks.count());
    OwnedRows rows;
    MeshFingerprint whole;
    ranks.together([&] {
      if (blocks_ < ranks.count())
        throw DataError(fmt::format("expected at least a part for each of {} ranks, found {}", ranks.count(), blocks_));
      if (ranks.is_first()) make_directory();
    });
    ranks.together([&] {
      for (std::int32_t i = owners.first_of(ranks.rank()); i < owners.first_of(ranks.rank() + 1); ++i)
        whole = read_part(i, rows);
    });
    expect_same_mesh(ranks, whole);
    return own_.size() == 1 ? std::move(rows) : in_order(rows);
  }

  void write(Ranks& ranks, const LocalGraph& local, const nlohmann::ordered_json& details) override {
    ranks.together([&] {
      for (Part& part : own_) {
        pipeline::SolutionProduct product;
        for (std::size_t v = 0; v < part.keys.size(); ++v) {
          const auto found = std::ranges::lower_bound(local.keys, part.keys[v]);
          const bool is_held = found != local.keys.end() && *found == part.keys[v];
          if (is_held && local.chosen[found - local.keys.begin()] != 0)
            product.solution.push_back(static_cast<std::int32_t>(v));
        }
        part.stage->write(product, details);
      }
    });
  }

 private:
  struct Part {
    std::unique_ptr<pipeline::Stage> stage;
    std::vector<std::uint64_t> keys;  // by number in the part
  };

  void make_directory() const {
    std::error_code error;
    std::filesystem::create_directories(context_.streams.output, error);
    if (error) throw DataError::at(context_.streams.output, "cannot make this directory: {}", error.message());
  }

  MeshFingerprint read_part(std::int32_t number, OwnedRows& rows) {
    const std::filesystem::path file = files_[number];
    RunContext context = context_;
    context.streams.operand = file.string();
    context.streams.output = (std::filesystem::path(context_.streams.output) / file.filename()).string();
    Part& part = own_.emplace_back();
    part.stage = std::make_unique<pipeline::Stage>(context);
    const pipeline::StageData data =
        part.stage->read({.needs = {Role::graph}, .wants = {Role::candidates, Role::solution}, .part = true});
    if (!data.part || !data.candidate_keys || data.candidate_keys->part.empty())
      throw DataError::at(file.string(), "expected a part of a graph as buildgraph --neighbours makes it, found none");
    if (data.part->parts != blocks_ || data.part->part != number)
      throw DataError::at(file.string(), "expected part {} of {}, found {}", number, blocks_, title_of(*data.part));
    append_rows(data, rows);
    part.keys = data.candidate_keys->key;
    return data.part->whole;
  }

  void expect_same_mesh(Ranks& ranks, const MeshFingerprint& whole) const {
    Packer packer;
    packer.put(whole);
    packer.put_all(std::span<const char>(files_.front()));
    Bytes first = packer.take();
    ranks.broadcast(first);
    Unpacker unpacker(first);
    const auto expected = unpacker.get<MeshFingerprint>();
    std::vector<char> name;
    unpacker.get_all(name);
    ranks.together([&] {
      if (whole != expected)
        throw DataError::at(files_[BlockOwners(blocks_, ranks.count()).first_of(ranks.rank())],
                            "expected a part of the mesh of {}, found one of another mesh",
                            std::string_view(name.data(), name.size()));
    });
  }

  RunContext context_;
  std::vector<std::string> files_;
  std::vector<Part> own_;
};

}  // namespace

std::unique_ptr<Source> graph_parts(const RunContext& context, std::vector<std::string> files) {
  return std::make_unique<GraphParts>(context, std::move(files));
}

}  // namespace hexpipe::lns_mpi
