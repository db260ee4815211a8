#pragma once
// What each vertex of a small dense graph would gain if it were pushed into an independent set, for a search that asks
// for the greatest after every change. A change goes over all vertices, several at once, by the rows of a bit matrix:
// where a vertex is in conflict with a tenth of all others this is faster than to go over its neighbours, and finds the
// greatest on the way.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/ground/dense_graph.hpp"
#include "common/run/random.hpp"

namespace hexpipe::mwis::local_search {

class PushGains {
 public:
  // Whether the rows of such a graph take little memory, and its weights leave room for marks in the gains.
  static bool suit(const graph::ConflictGraph& graph);
  // Of the empty set, with the narrowest numbers that hold the gains. `graph` must live as long as the result.
  static std::unique_ptr<PushGains> make(const ground::DenseGraph& graph);
  virtual ~PushGains() = default;

  // A barred vertex is never the greatest. It must not be barred twice.
  virtual void bar(std::size_t v) = 0;
  virtual void free(std::size_t v) = 0;
  // The vertex came into the set, or left it: its neighbours gain less, or more. Done by the next settle().
  virtual void come_in(std::size_t v) = 0;
  virtual void go_out(std::size_t v) = 0;
  // The greatest gain of a vertex that is not barred; none if all are.
  virtual std::optional<std::int64_t> settle() = 0;
  // Of a vertex that is not barred, after settle().
  virtual std::int64_t gain(std::size_t v) const = 0;
  // A vertex with the gain that settle() has just returned, by chance if there are several.
  virtual std::size_t greatest(Random& random) const = 0;
};

}  // namespace hexpipe::mwis::local_search
