#pragma once
// Which of the ways to improve fragments gets the next work: the one that would be most behind its share after that
// work, so that a way that takes seconds waits until the search is that long. Shares follow what each has gained lately
// for its work.

#include <array>
#include <vector>

namespace hexpipe::mwis::local_search {

enum class Way {
  exact,      // branch and bound on fragments of some hundred vertices
  anneal,     // annealing of fragments of some thousand from what is chosen
  recombine,  // annealing from nothing, and the best of both: what is chosen and what was found
};
inline constexpr std::array all_ways{Way::exact, Way::anneal, Way::recombine};

class Effort {
 public:
  struct Account {
    double credit = 0;  // work that it is behind its share
    double cost = 0;    // work at a time
    double yield = 0;   // gain a unit of work, of late
  };
  using Accounts = std::array<Account, all_ways.size()>;  // by way

  // At least one way. Each keeps some share.
  explicit Effort(std::vector<Way> ways = {all_ways.begin(), all_ways.end()}) : ways_(std::move(ways)) {}

  // Growing a fragment and putting it back takes a microsecond, where there is nothing to do in between: what counted
  // as nothing would have the next turn again, for ever.
  static constexpr double least_work = 1000;

  // What this way does at a time; 0 unless told.
  void expect(Way way, double work) { of(way).cost = work; }
  Way next() const;
  // `work` in nanoseconds, roughly, of which the latest tenths of a second decide the shares.
  void record(Way way, double work, double gain);
  double share_of(Way way) const;

  // To go on as an earlier search ended.
  const Accounts& accounts() const { return accounts_; }
  void recall(const Accounts& accounts) { accounts_ = accounts; }

 private:
  Account& of(Way way) { return accounts_[static_cast<std::size_t>(way)]; }
  const Account& of(Way way) const { return accounts_[static_cast<std::size_t>(way)]; }

  std::vector<Way> ways_;
  Accounts accounts_;
};

}  // namespace hexpipe::mwis::local_search
