#pragma once
// Fragments: connected parts of the conflict graph that are freed and solved anew while everything else stays.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mwis/dense_graph.hpp"
#include "common/mwis/solution_state.hpp"
#include "common/run/random.hpp"

namespace hexpipe {

// Everything that can be chosen once `released` are no longer: these and the vertices with no other chosen neighbour.
struct Fragment {
  std::vector<std::int32_t> released;  // chosen vertices, from the seed outwards
  std::vector<std::int32_t> vertices;  // free ones, the released among them
  std::vector<std::int32_t> frontier;  // chosen vertices that would have been released next
  bool whole_component = false;        // nothing of the connected component is outside
  std::uint32_t stamp = 0;

  void clear();
};

// Grows fragments from seeds, each at a cost of O(sum of the degrees of its vertices), without allocation once its
// memory has grown. Fragments of one round do not touch each other, so that they can be solved at the same time.
class FragmentGrower {
 public:
  FragmentGrower(const SolutionState& state, Random random);

  // Forgets the fragments of the last round; the state may have changed.
  void begin_round();
  // False when a fragment of this round has the vertex or a neighbour of it.
  bool is_free(std::int32_t v) const { return marks_[v].claim < round_begin_; }
  // Releases chosen vertices around `seed`, itself free and chosen, until at least `target` vertices are free or the
  // component is. No more than `limit` become free, which matters at vertices of high degree.
  void grow(std::int32_t seed, std::size_t target, std::size_t limit, Fragment& fragment);

  // The graph of the fragment's vertices; `chosen` gets the released ones. Safe to call at the same time for several
  // fragments of this round.
  void extract(const Fragment& fragment, DenseGraph& graph, std::vector<bits::Word>& chosen) const;

 private:
  struct Mark {
    std::uint32_t claim = 0;    // fragment that has this vertex or a neighbour of it
    std::uint32_t member = 0;   // fragment that has this vertex
    std::int32_t index = 0;     // in its vertices
    std::uint32_t touched = 0;  // fragment for which the next two count
    std::int32_t released_neighbours = 0;
    std::uint32_t released_sum = 0;  // of their numbers
    std::uint32_t queued = 0;        // fragment whose frontier this chosen vertex is in
  };

  void release(std::int32_t v, std::size_t limit, Fragment& fragment);
  void touch(std::int32_t v, std::int32_t released, std::size_t limit, Fragment& fragment);
  void include(std::int32_t v, Fragment& fragment);
  void queue(std::int32_t v, Fragment& fragment);
  void vary(std::size_t next, Fragment& fragment);
  bool queue_beyond(Fragment& fragment);

  const SolutionState& state_;
  Random random_;
  std::vector<Mark> marks_;
  std::vector<std::int32_t> partly_freed_;  // touched vertices that were not freed at once
  std::size_t next_partly_freed_ = 0;
  std::size_t next_vertex_ = 0;  // of the fragment, whose neighbours were not looked at for want of anything nearer
  std::uint32_t stamp_ = 0, round_begin_ = 1;
  bool left_out_ = false;  // a vertex was not freed because of another fragment or the limit
};

}  // namespace hexpipe
