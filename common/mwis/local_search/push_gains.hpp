#pragma once
// The gain of each vertex of a small dense graph: how much heavier an independent set becomes if the vertex comes in
// and its chosen neighbours go out. For a search that asks for the greatest gain after every change. A change goes over
// all vertices, several at once, by the rows of a bit matrix. Where a vertex is in conflict with a tenth of all others
// this is faster than to go over its neighbours, and it finds the greatest gain on the way.

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
  // Whether the bit matrix of such a graph takes little memory, and its weights are small enough to mark barred
  // vertices by their gains.
  static bool suit(const graph::ConflictGraph& graph);
  // The gains for the empty set, in the narrowest integers that hold them. `graph` must outlive the result.
  static std::unique_ptr<PushGains> make(const ground::DenseGraph& graph);
  virtual ~PushGains() = default;

  // A barred vertex does not count for the greatest gain. It must not be barred twice.
  virtual void bar(std::size_t v) = 0;
  virtual void free(std::size_t v) = 0;
  // The vertex comes into the set, or leaves it, so that its neighbours gain less, or more. settle() has to follow.
  virtual void come_in(std::size_t v) = 0;
  virtual void go_out(std::size_t v) = 0;
  // Brings the gains up to date. Returns the greatest one of a vertex that is not barred; nullopt if all are.
  virtual std::optional<std::int64_t> settle() = 0;
  // The gain of a vertex that is not barred, after settle().
  virtual std::int64_t gain(std::size_t v) const = 0;
  // A vertex with the gain that settle() has just returned, drawn at random if there are several.
  virtual std::size_t greatest(Random& random) const = 0;
};

}  // namespace hexpipe::mwis::local_search
