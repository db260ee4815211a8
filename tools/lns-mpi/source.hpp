#pragma once
// Where the rows of each rank come from and where the solution goes: a graph that fits the first rank, or parts that
// were made apart and never meet in one place.

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/run/run_context.hpp"
#include "tools/lns-mpi/piece.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

class Source {
 public:
  virtual ~Source() = default;
  // All ranks call these together. Throws on all of them when one cannot read or write.
  virtual OwnedRows read(Ranks& ranks) = 0;
  virtual void write(Ranks& ranks, const Piece& piece, const nlohmann::ordered_json& details) = 0;

  // After read, the same on all ranks.
  std::int32_t blocks() const { return blocks_; }
  // The lowest bound that certify has proven, by the history of the input; below 0: none.
  std::int64_t bound() const { return bound_; }

 protected:
  std::int32_t blocks_ = 0;
  std::int64_t bound_ = -1;
};

// Read and cut by the first rank into so many blocks, of which the others get theirs; 0: as many as its size asks for.
std::unique_ptr<Source> whole_graph(const RunContext& context, std::int32_t blocks);

// A bundle for each part, in their order, as buildgraph makes them; the solution goes into bundles of the same names in
// the directory that the command line names as output.
std::unique_ptr<Source> graph_parts(const RunContext& context, std::vector<std::string> files);

}  // namespace hexpipe::lns_mpi
