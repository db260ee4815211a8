#pragma once
// A linear program with a variable from 0 to 1 for each vertex and a row for each clique, of which at most 1 is chosen.
// It uses COIN-OR's simplex (CLP). Cliques may be added, and the simplex then continues from the last basis.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/mwis/bounds/relaxation.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::exact {

class PackingProgram {
 public:
  explicit PackingProgram(std::span<const std::int64_t> weights);
  ~PackingProgram();
  PackingProgram(const PackingProgram&) = delete;
  PackingProgram& operator=(const PackingProgram&) = delete;

  void add_row(std::span<const std::int32_t> clique);

  // False if the deadline passed first, or the solver gave up. Its prices are useful even then.
  bool solve(const Deadline& deadline);

  // By vertex: how much of it the heaviest fractional set has, from 0 to 1.
  const std::vector<double>& fractions() const { return fractions_; }
  // By row, in the order in which rows were added; 0 or more.
  const std::vector<double>& prices() const { return prices_; }

 private:
  class Simplex;
  std::unique_ptr<Simplex> simplex_;
  std::vector<double> fractions_, prices_;
};

// The relaxation of branch and cut: LP-Clique (Verhetsel 2017, 3.2) by the simplex method on an edge clique cover.
// Cliques that the fractional solution violates are added until there is none (Nemhauser and Sigismondi 1992). Unlike
// there, the prices alone prove the bounds, in whole numbers, so nothing depends on the tolerances of the simplex.
bounds::Relaxation relax_by_cutting_planes(const graph::ConflictGraph& graph, std::int64_t target, int depth,
                                           const Deadline& deadline);

}  // namespace hexpipe::mwis::exact
