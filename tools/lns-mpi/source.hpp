#pragma once
// Where the rows of each rank come from and where the solution goes: either a graph that fits the first rank, or parts
// that were made separately and never meet in one place.

#include <cstdint>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/run/run_context.hpp"
#include "tools/lns-mpi/local_graph.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

class Source {
 public:
  virtual ~Source() = default;
  // All ranks call these together. Throws on all of them when one cannot read or write.
  virtual OwnedRows read(Ranks& ranks) = 0;
  virtual void write(Ranks& ranks, const LocalGraph& local, const nlohmann::ordered_json& details) = 0;

  // Valid after read(), the same on all ranks.
  std::int32_t blocks() const { return blocks_; }
  // The lowest bound that certify has proven, if the input's history has one.
  std::optional<std::int64_t> bound() const { return bound_; }
  // Vertices from this number on are quads (buildgraph --quad-reward), and what these weigh.
  std::uint64_t candidates() const { return candidates_; }
  std::int64_t weight_of_quads() const { return weight_of_quads_; }

 protected:
  std::int32_t blocks_ = 0;
  std::optional<std::int64_t> bound_;
  std::uint64_t candidates_ = std::numeric_limits<std::uint64_t>::max();
  std::int64_t weight_of_quads_ = 0;
};

// Cuts a conflict graph into blocks of about the same size, with few edges between them.
//
// The block of each vertex. Every block from 0 on is used unless there are fewer vertices. Depends only on the graph
// and the number of blocks.
std::vector<std::int32_t> cut_into_blocks(const graph::ConflictGraph& graph, std::int32_t blocks);

// The first rank reads the graph and cuts it into `blocks` blocks (0: as many as its size asks for), and sends the
// other ranks theirs.
std::unique_ptr<Source> whole_graph(const RunContext& context, std::int32_t blocks);

// `files` has a bundle for each part, in the parts' order, as buildgraph makes them. The solution goes into bundles of
// the same names in the directory that the command line names as output.
std::unique_ptr<Source> graph_parts(const RunContext& context, std::vector<std::string> files);

}  // namespace hexpipe::lns_mpi
