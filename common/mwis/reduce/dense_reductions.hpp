#pragma once
// Exact reductions of a small graph: vertices that can be decided without search are decided, and the solution of the
// rest is lifted back. The rules are those of Lamm et al. 2019 and Gu et al. 2021. They add up the weights of a set of
// neighbours; here a clique cover bounds its heaviest independent set, because the conflicts of cells come in cliques.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mwis/bounds/clique_cover_bound.hpp"
#include "common/mwis/ground/dense_graph.hpp"

namespace hexpipe::mwis::reduce {

// Reuses its memory for the next graph.
class DenseReductions {
 public:
  // Changes the weights of `graph`, whose vertices stay; left() tells which are undecided. lift() makes each of their
  // solutions heavier by offset(), and an optimal one optimal.
  void reduce(ground::DenseGraph& graph);

  const bits::Word* left() const { return alive_.data(); }
  std::int64_t offset() const { return offset_; }
  // `chosen` holds a solution of the vertices left; it becomes one of the whole graph.
  void lift(bits::Word* chosen) const;

 private:
  enum class Step : std::uint8_t { take, take_if_free };
  struct Decision {
    Step step;
    std::uint32_t vertex;
  };

  bool decide(std::uint32_t v);
  bool outweighs_neighbourhood(std::uint32_t v, std::int64_t neighbour_sum);
  bool neighbourhood_is_clique() const;
  void transfer_weight(std::uint32_t v);
  bool some_neighbour_replaces(std::uint32_t v);
  bool drop_common_neighbours(std::uint32_t v, std::int64_t neighbour_sum);

  void take(std::uint32_t v);
  void drop(std::uint32_t v);
  void touch_neighbours(std::uint32_t v);

  ground::DenseGraph* graph_ = nullptr;
  std::size_t words_ = 0;
  std::int64_t offset_ = 0;
  std::vector<bits::Word> alive_, touched_;
  std::vector<bits::Word> around_;  // the undecided neighbours of the current vertex
  std::vector<bits::Word> scratch_;
  bounds::CliqueCoverBound bound_;
  std::vector<Decision> decisions_;
};

}  // namespace hexpipe::mwis::reduce
