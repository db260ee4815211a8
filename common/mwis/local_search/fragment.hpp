#pragma once
// Fragments: connected subgraphs of the conflict graph that are freed and solved anew while everything else stays.

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "common/mwis/ground/dense_graph.hpp"
#include "common/mwis/ground/solution_state.hpp"
#include "common/run/random.hpp"

namespace hexpipe::mwis::local_search {

// The vertices that become free when those of `released` leave the solution: these, and all without another chosen
// neighbour.
struct Fragment {
  std::vector<std::int32_t> released;  // chosen vertices, from the seed outwards
  std::vector<std::int32_t> vertices;  // the free vertices, with the released ones
  std::vector<std::int32_t> frontier;  // chosen vertices that would have been released next
  bool whole_component = false;        // the fragment is a whole connected component
  bool is_cut_off = false;             // nothing is left to release in its component but what could not be freed
  std::uint32_t stamp = 0;

  void clear();
};

// Grows fragments from seeds, each at a cost of O(sum of the degrees of its vertices), without allocation once its
// memory has grown. Fragments do not touch fragments that are held, so they can be solved at the same time.
class FragmentGrower {
 public:
  FragmentGrower(const ground::SolutionState& state, Random random);

  // Releases the hold on all fragments; the state may have changed.
  void let_go();
  // Releases the hold on one fragment; the state may have changed in it.
  void let_go(const Fragment& fragment);
  // False if a held fragment has the vertex or a neighbour of it.
  bool is_free(std::int32_t v) const { return !is_held(marks_[v].claim); }
  // Grows a fragment around `seed`, a chosen vertex for which is_free() holds: releases chosen vertices until at least
  // `target` vertices are free or the component is complete. At most `limit` become free, which matters at vertices of
  // high degree. The fragment is held from then on.
  void grow(std::int32_t seed, std::size_t target, std::size_t limit, Fragment& fragment);

  // Copies the graph of the fragment's vertices, numbered by their place in the fragment; `chosen` gets the released
  // ones. Several threads may extract held fragments at the same time.
  void extract(const Fragment& fragment, ground::DenseGraph& graph, std::vector<bits::Word>& chosen) const;
  // The same for fragments that are too large for a matrix. The fragment's vertices must ascend.
  void extract(const Fragment& fragment, graph::ConflictGraph& graph, graph::IndependentSet& chosen) const;
  // Sorts the fragment's vertices.
  void sort(Fragment& fragment);

 private:
  struct Mark {
    std::uint32_t claim = 0;    // fragment that has this vertex or a neighbour of it
    std::uint32_t member = 0;   // fragment that has this vertex
    std::int32_t index = 0;     // of the vertex in that fragment
    std::uint32_t touched = 0;  // fragment for which the next two values count
    std::int32_t released_neighbours = 0;
    std::uint32_t released_sum = 0;  // sum of their numbers
    std::uint32_t queued = 0;        // fragment whose frontier has this chosen vertex
  };

  void release(std::int32_t v, std::size_t limit, Fragment& fragment);
  void touch(std::int32_t v, std::int32_t released, std::size_t limit, Fragment& fragment);
  void include(std::int32_t v, Fragment& fragment);
  void queue(std::int32_t v, Fragment& fragment);
  void vary(std::size_t next, Fragment& fragment);
  bool queue_beyond(Fragment& fragment);
  bool is_held(std::uint32_t stamp) const { return stamp >= oldest_held_ && held_[stamp - oldest_held_] != 0; }

  const ground::SolutionState& state_;
  Random random_;
  std::vector<Mark> marks_;
  std::vector<std::int32_t> partly_freed_;  // touched vertices that were not freed at once
  std::size_t next_partly_freed_ = 0;
  std::size_t next_vertex_ = 0;  // in the fragment; its neighbours are examined when nothing nearer is left
  std::uint32_t stamp_ = 0;
  std::uint32_t oldest_held_ = 1;
  std::deque<char> held_;  // by stamp, from the oldest held one
  bool left_out_ = false;  // a vertex was not freed because of another fragment or the limit
};

}  // namespace hexpipe::mwis::local_search
