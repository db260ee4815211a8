#pragma once
// Tabu search over pushes (multi-neighbourhood tabu search: Wu, Hao, Glover 2012). In each move the vertex with the
// greatest gain comes in, even if that is a loss, and its chosen neighbours go out; these may not come back for some
// moves (their tenure). After many moves in vain the search starts again from the empty set. Where few vertices are
// chosen this finds what coolings miss (docs/log/mwis.md).

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/ground/dense_graph.hpp"
#include "common/mwis/local_search/push_gains.hpp"
#include "common/run/deadline.hpp"
#include "common/run/random.hpp"

namespace hexpipe::mwis::local_search {

// The length of the i-th start, i from 1: 1, 1, 2, 1, 1, 2, 4, ... In this sequence each length gets the same time in
// total (Luby, Sinclair, Zuckerman 1993), because nobody knows which one suits the graph.
std::int64_t luby(std::int64_t i);

class PushTabu {
 public:
  // PushGains::suit() must hold for the graph.
  PushTabu(const graph::ConflictGraph& graph, Random random);

  // Makes `moves` more moves, from where the last call ended; fewer if the deadline passes or touched() comes to
  // `most_touched`.
  void run(std::int64_t moves, const Deadline& deadline, double most_touched = std::numeric_limits<double>::infinity());

  std::int64_t best_weight() const { return best_weight_; }
  // Ascending.
  graph::IndependentSet best() const;
  std::int64_t moves() const { return moves_; }
  // The tenure of the starts that reach most: a vertex stays out for at least so many moves, and for less than twice as
  // many.
  std::int64_t usual_tenure() const { return tenures[best_tenure()]; }
  // The work done, in neighbours that a walk touches in the same time.
  double touched() const { return touched_; }

  // Whether the gains are right; for tests.
  bool check() const;

 private:
  static constexpr std::array<std::int64_t, 7> tenures{5, 7, 10, 14, 20, 28, 40};

  // What the starts with a tenure have reached.
  struct Experience {
    std::int64_t starts = 0;
    double reached = 0;  // in the mean
  };

  void begin();
  void end();
  std::size_t best_tenure() const;
  void move();
  void come_in(std::size_t v);
  void go_out(std::size_t v);
  void free_tabu(std::vector<std::size_t>& vertices);

  ground::DenseGraph graph_;
  Random random_;
  std::unique_ptr<PushGains> gains_;
  std::vector<bits::Word> chosen_, pushed_out_;  // the latter by the last move
  std::int64_t weight_ = 0;
  std::array<std::vector<std::size_t>, static_cast<std::size_t>(2 * tenures.back())> free_at_;  // by move, modulo
  std::int64_t moves_ = 0, in_vain_ = 0;
  double touched_ = 0;
  std::array<Experience, tenures.size()> experience_;
  std::int64_t starts_ = 0, long_starts_ = 0;
  std::size_t tenure_ = 0;         // of this start: its place in tenures
  std::int64_t most_in_vain_ = 0;  // of this start
  std::int64_t heaviest_ = 0;      // since it began anew
  std::int64_t best_weight_ = 0;
  std::vector<bits::Word> best_;
};

}  // namespace hexpipe::mwis::local_search
