#pragma once
// Keeps the state of a search on disk, in a file for each rank. Either all files of a round are whole, or none counts.
//
//   DIR/checkpoint.json      the round that counts, and the graph that it belongs to
//   DIR/round-12/0003.tar    the fourth rank: the numbers of the vertices that it chose, and what
//                            the searches of its blocks remember
//
// checkpoint.json is replaced when all files of a round are there; only then is the round before it removed.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/lns-mpi/local_graph.hpp"
#include "tools/lns-mpi/ranks.hpp"
#include "tools/lns-mpi/rounds.hpp"

namespace hexpipe::lns_mpi {

class Checkpoint {
 public:
  // Makes the directory. `fingerprint` is that of the graph. All ranks call this and the functions below together.
  // Throws on all ranks if one cannot read or write.
  Checkpoint(Ranks& ranks, std::string directory, double seconds_between, std::uint64_t fingerprint);

  // Returns the keys of the vertices that an earlier run chose in the blocks of this rank, ascending; some of other
  // blocks may be among them. Stores the rest in `progress` and `memories`. Without a checkpoint, returns nullopt and
  // changes nothing. Throws DataError if the checkpoint is damaged or of another graph.
  std::optional<std::vector<std::uint64_t>> resume(const BlockOwners& owners, RoundsProgress& progress,
                                                   std::vector<BlockMemory>& memories);

  // Whether it is time for the next checkpoint.
  bool is_due();
  void write(const LocalGraph& local, const RoundsProgress& progress, const std::vector<BlockMemory>& memories);

 private:
  std::filesystem::path folder_of(std::int64_t round) const;
  void remove_rounds_but(const std::filesystem::path& kept) const;

  Ranks& ranks_;
  std::filesystem::path directory_;
  double seconds_between_;
  std::uint64_t fingerprint_;
  Stopwatch watch_;
  double next_;
  // The round that checkpoint.json names.
  std::optional<std::int64_t> round_;
};

}  // namespace hexpipe::lns_mpi
