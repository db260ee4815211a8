#pragma once
// Exact reductions of a conflict graph, from the centre of a neighbourhood. All rules follow from one question: which
// independent sets of neighbours outweigh the centre v? A solution has v or one of these sets. If there is none, v is
// taken (neighbourhood removal). Neighbours in no such set are dropped (domination, basic and extended single edge). If
// the sets are few, vertices that stand for them replace v and its neighbours (extended struction, Gellner et al. 2021,
// with simplicial weight transfer and the folds of small degree as special cases). Two things differ from there: clique
// covers bound neighbourhoods, because the conflicts of cells come in cliques, and sets that another one dominates are
// left out.

#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "common/mwis/bounds/clique_cover_bound.hpp"
#include "common/mwis/ground/dense_graph.hpp"
#include "common/mwis/reduce/heavy_sets.hpp"
#include "common/mwis/reduce/reducible_graph.hpp"
#include "common/mwis/reduce/reduction_log.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::reduce {

enum class ReductionEffort {
  quick,     // what clique covers prove, while this decides vertices often enough: a fraction of a second
  worth,     // like quick, then like full and thorough while the decisions are worth their work
  full,      // all rules that leave fewer vertices at once
  thorough,  // all rules, and folds that add vertices if other rules then remove more: seconds to minutes
};

class Reducer {
 public:
  // Decides nothing around vertices in `incomplete`, because they have neighbours that the graph does not show.
  Reducer(const graph::ConflictGraph& graph, ReductionLog& log, std::vector<char> incomplete = {});

  // Runs until no rule applies any more, or until the deadline. Returns how much heavier solutions become by the lift.
  std::int64_t run(ReductionEffort effort, const Deadline& deadline);
  // The work of run so far: roughly nanoseconds, but the same on every machine.
  double work() const { return work_; }

  ReducibleGraph& graph() { return graph_; }

 private:
  // Vertices whose neighbourhood changed, each listed once.
  struct Queue {
    std::deque<std::int32_t> vertices;
    std::vector<char> waiting;
    void push(std::int32_t v);
    std::int32_t pop();
    void clear();
  };

  // The work that reductions may still spend. Each vertex that they decide adds to it.
  struct WorkBudget {
    double left, most, pay;
    std::int32_t alive;  // when pay was last added
    double work;
  };

  bool is_complete(std::int32_t v) const {
    return static_cast<std::size_t>(v) >= incomplete_.size() || incomplete_[v] == 0;
  }
  void reduce_while_worth(const Deadline& deadline);
  void skim(const Deadline& deadline);
  void settle(const Deadline& deadline, std::int32_t wanted);
  void blow_up(const Deadline& deadline);
  void try_fold(std::int32_t v, const Deadline& deadline);
  void take_back(std::size_t decided, std::int64_t offset);
  void estimate(std::int32_t v, std::int32_t growth);

  void open_budget();
  bool is_worth_it();

  void decide(std::int32_t v);
  bool may_decide(std::int64_t weight);
  void keep_open_beside(std::int32_t x);
  bool gather_around(std::int32_t v);
  void sort_around();
  void count_look();
  void build_rows();
  template <class Wanted>
  bool build_rows_while(Wanted&& wanted);
  bool build_rows_of_few_sets(std::int64_t limit, std::size_t most);
  void set_place(std::int32_t v, std::size_t i);
  void build_row(std::int32_t v, bits::Word* row);
  bool bound_without(const bits::Word* excluded, std::int64_t limit);
  bool drop_replaceable(std::int32_t v);

  void decide_by_sets(std::int32_t v);
  bool find_sets(std::int32_t v);
  bool drop_outside_sets();
  void collect_sets();
  void look_outside();
  void fold(std::int32_t v);

  void take(std::int32_t v);
  void drop(std::int32_t v);

  ReducibleGraph graph_;
  ReductionLog& log_;
  const std::vector<char> incomplete_;
  std::int64_t offset_ = 0;
  Queue queue_, set_queue_;
  double work_ = 0;  // roughly in nanoseconds, but the same on every machine
  std::optional<WorkBudget> budget_;

  // How many vertices a fold of the vertex would add, if that is known. The queue has the fewest first; some of its
  // entries are outdated.
  static constexpr std::int32_t unknown = std::numeric_limits<std::int32_t>::max();
  using Growth = std::pair<std::int32_t, std::int32_t>;  // the growth and the vertex
  std::vector<std::int32_t> growth_;
  std::priority_queue<Growth, std::vector<Growth>, std::greater<>> growths_;
  bool trying_ = false;
  std::vector<Growth> growth_before_;  // the current try

  struct Weighted {
    std::int64_t weight;
    std::int32_t vertex;
  };

  // The neighbourhood that is being examined, at first in any order.
  std::vector<Weighted> by_weight_;
  std::vector<Weighted> open_;  // neighbours that may still be dropped
  // The same, the heaviest vertex first, as a small graph.
  std::vector<std::int32_t> around_;
  std::vector<std::int32_t> places_;  // in around_, while local_ is built, if its rows have several words
  std::vector<bits::Word> word_of_;   // the place as a bit, while local_ is built, if its rows have one word
  ground::DenseGraph local_;
  std::vector<bits::Word> set_, excluded_;
  bounds::CliqueCoverBound bound_;
  HeavySets heavy_sets_;
  std::vector<std::pair<std::int64_t, std::size_t>> set_order_;  // of heavy_sets_: weights below zero, and numbers
  std::vector<std::size_t> sets_;      // the heavy_sets_ that a fold has to keep, the heaviest first
  std::vector<std::int32_t> outside_;  // the neighbours' other neighbours, ascending
  std::size_t outside_words_ = 0;
  std::vector<bits::Word> conflicts_;      // a row over outside_ for each of around_
  std::vector<bits::Word> set_conflicts_;  // a row over outside_ for each of sets_, and room for more
};

}  // namespace hexpipe::mwis::reduce
