#pragma once
// Where a search has come to, on disk: a file for each rank, of which all are whole or none counts.
//
//   DIR/checkpoint.json      the round that counts, and of what it is
//   DIR/round-12/0003.tar    of the fourth rank: the numbers of the vertices that it chose, and what
//                            the searches of its blocks remember
//
// checkpoint.json is replaced when all files of a round are there, and the round before goes only then.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/lns-mpi/piece.hpp"
#include "tools/lns-mpi/ranks.hpp"
#include "tools/lns-mpi/rounds.hpp"

namespace hexpipe::lns_mpi {

class Checkpoint {
 public:
  // Makes the directory. `fingerprint` is of the graph. All ranks call this and all that follows together.
  Checkpoint(Ranks& ranks, std::string directory, double seconds_between, std::uint64_t fingerprint);

  // What an earlier run left: the keys of the vertices that it chose in the blocks of this rank, ascending, maybe with
  // those of others; the rest goes into what is named. Nothing, with nothing changed, where there is no checkpoint.
  // Throws DataError when it is damaged or of another graph.
  std::optional<std::vector<std::uint64_t>> resume(const BlockOwners& owners, RoundsProgress& progress,
                                                   std::vector<BlockMemory>& memories);

  // Whether so much time has passed since the last one.
  bool is_due();
  void write(const Piece& piece, const RoundsProgress& progress, const std::vector<BlockMemory>& memories);

 private:
  std::filesystem::path folder_of(std::int64_t round) const;
  void remove_rounds_but(const std::filesystem::path& kept) const;

  Ranks& ranks_;
  std::filesystem::path directory_;
  double seconds_between_;
  std::uint64_t fingerprint_;
  Stopwatch watch_;
  double next_;
  // That of which checkpoint.json speaks.
  std::optional<std::int64_t> round_;
};

}  // namespace hexpipe::lns_mpi
