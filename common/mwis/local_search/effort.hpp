#pragma once
// Adaptive operator selection: decides which of the operators that improve fragments gets the next work. It is the one
// that would be furthest behind its share after that work, so an operator that takes seconds waits until the search is
// long enough. Shares follow the recent gain per work of each operator.

#include <array>
#include <vector>

namespace hexpipe::mwis::local_search {

enum class Way {
  exact,      // branch and bound on fragments of some hundred vertices
  anneal,     // annealing of fragments of some thousand vertices, from the present choice
  recombine,  // annealing from an empty set, then the best combination of the result and the present choice
};
inline constexpr std::array all_ways{Way::exact, Way::anneal, Way::recombine};

class Effort {
 public:
  struct Account {
    double credit = 0;  // work by which it is behind its share
    double cost = 0;    // work of one use
    double yield = 0;   // recent gain per unit of work
  };
  using Accounts = std::array<Account, all_ways.size()>;  // by operator

  // Needs at least one operator. Each keeps some share.
  explicit Effort(std::vector<Way> ways = {all_ways.begin(), all_ways.end()}) : ways_(std::move(ways)) {}

  // Growing a fragment and putting it back takes a microsecond, even if there is nothing to do in between. An operator
  // whose work counted as nothing would get every next turn, for ever.
  static constexpr double least_work = 1000;

  // The work of one use of this operator; 0 until told.
  void expect(Way way, double work) { of(way).cost = work; }
  Way next() const;
  // `work` is roughly in nanoseconds. The last tenths of a second decide the shares.
  void record(Way way, double work, double gain);
  double share_of(Way way) const;

  // Used to continue as an earlier search ended.
  const Accounts& accounts() const { return accounts_; }
  void recall(const Accounts& accounts) { accounts_ = accounts; }

 private:
  Account& of(Way way) { return accounts_[static_cast<std::size_t>(way)]; }
  const Account& of(Way way) const { return accounts_[static_cast<std::size_t>(way)]; }

  std::vector<Way> ways_;
  Accounts accounts_;
};

}  // namespace hexpipe::mwis::local_search
