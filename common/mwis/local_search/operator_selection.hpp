#pragma once
// Adaptive operator selection: decides which of the operators that improve fragments gets the next work. It chooses
// the operator that would be furthest behind its share after that work, so an operator that takes seconds waits until
// the search is long enough. Shares follow the recent gain per work of each operator.

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace hexpipe::mwis::local_search {

enum class Operator {
  exact,      // branch and bound on fragments of some hundred vertices
  anneal,     // annealing of fragments of some thousand vertices, from the present choice
  recombine,  // annealing from an empty set, then the best combination of the result and the present choice
};
inline constexpr std::array all_operators{Operator::exact, Operator::anneal, Operator::recombine};
constexpr std::size_t index_of(Operator op) {
  return static_cast<std::size_t>(op);
}

// How an operator has done so far.
struct OperatorScore {
  double credit = 0;  // work by which it is behind its share
  double cost = 0;    // work of one use
  double yield = 0;   // recent gain per unit of work
};
using OperatorScores = std::array<OperatorScore, all_operators.size()>;  // by operator

class OperatorSelection {
 public:
  // The least share of each operator, because its gains may come later. The sum must be below 1.
  using LeastShares = std::array<double, all_operators.size()>;
  static constexpr LeastShares usual_least_shares{0.2, 0.2, 0.1};

  // Needs at least one operator.
  explicit OperatorSelection(std::vector<Operator> operators = {all_operators.begin(), all_operators.end()},
                             const LeastShares& least_shares = usual_least_shares)
      : operators_(std::move(operators)), least_shares_(least_shares) {}

  // Growing a fragment and putting it back takes a microsecond, even if there is nothing to do in between. An operator
  // whose work counted as nothing would get every next turn, for ever.
  static constexpr double least_work = 1000;

  // Sets the expected work of one use of this operator; 0 until then.
  void expect(Operator op, double work) { score_of(op).cost = work; }
  // The operator that gets the next work.
  Operator next() const;
  // After a use: its work, roughly in nanoseconds, and its gain in units of weight. The last tenths of a second decide
  // the shares.
  void record(Operator op, double work, double gain);
  double share_of(Operator op) const;

  // To continue as an earlier search ended.
  const OperatorScores& scores() const { return scores_; }
  void recall(const OperatorScores& scores) { scores_ = scores; }

 private:
  OperatorScore& score_of(Operator op) { return scores_[index_of(op)]; }
  const OperatorScore& score_of(Operator op) const { return scores_[index_of(op)]; }

  std::vector<Operator> operators_;
  LeastShares least_shares_;
  OperatorScores scores_;
};

}  // namespace hexpipe::mwis::local_search
