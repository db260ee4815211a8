#pragma once
// Which of two ways to improve fragments gets the next work: the one that is behind its share, and shares follow what
// each has gained lately for its work.

#include <array>

namespace hexpipe {

enum class Way {
  exact,   // branch and bound on fragments of some hundred vertices
  anneal,  // annealing of fragments of some thousand
};
inline constexpr std::array all_ways{Way::exact, Way::anneal};

class Effort {
 public:
  // The smallest share that a way keeps, at most a half: a fifth costs a quarter more time where the other way alone
  // would do.
  explicit Effort(double least_share = 0.2) : least_share_(least_share) {}

  Way next() const;
  // `work` in nanoseconds, roughly, of which the latest tenths of a second decide the shares.
  void record(Way way, double work, double gain);
  double share_of(Way way) const;

 private:
  struct Account {
    double credit = 0;  // work that it is behind its share
    double yield = 0;   // gain a unit of work, of late
  };
  Account& of(Way way) { return accounts_[static_cast<std::size_t>(way)]; }
  const Account& of(Way way) const { return accounts_[static_cast<std::size_t>(way)]; }

  double least_share_;
  std::array<Account, 2> accounts_;
};

}  // namespace hexpipe
