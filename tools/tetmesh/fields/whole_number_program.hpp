#pragma once
// Whole numbers that solve equations and are near to wanted numbers.

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace hexpipe::tetmesh::fields {

// Multiples of unknowns whose sum is zero.
using WholeEquation = std::map<std::int32_t, std::int32_t>;

// Bommes, Zimmer, Kobbelt: Mixed-integer quadrangulation (2009) round one unknown after the other, the surest first,
// and solve again for the rest. Here each equation is solved for an unknown of which it has one first, so that the
// others may be any whole numbers. Equations without such an unknown are left out.
class WholeNumberProgram {
 public:
  // Only the first unknowns have wanted numbers, the others may be anything. Squared misses count by the weights.
  WholeNumberProgram(std::vector<WholeEquation> equations, std::vector<double> wanted, std::vector<double> weights);

  // The best real numbers for the wanted unknowns; nothing where there are too many of them.
  std::optional<std::vector<double>> relax();
  // Whole numbers near the real ones found last.
  std::vector<std::int32_t> round() const;
  // Leaves out the equation with this unknown that the wanted numbers miss by most. False if no equation has the
  // unknown.
  bool drop_worst_of(std::int32_t unknown);

 private:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  std::int32_t wanted_count() const { return static_cast<std::int32_t>(wanted_.size()); }
  double missed_by(const WholeEquation& equation) const;
  void eliminate();
  bool solve_for_one(WholeEquation equation);
  void describe_by_free();
  void round_surest(Vector& free) const;
  void improve(Vector& free) const;

  std::vector<WholeEquation> equations_;
  std::vector<double> wanted_, weights_;
  std::map<std::int32_t, WholeEquation> solved_;  // unknowns as sums of multiples of the free ones
  Matrix by_free_;                                // the wanted unknowns, by the free ones
  // The free ones make least: free' energy free - 2 free' pull.
  Matrix energy_;
  Vector pull_, relaxed_;
};

}  // namespace hexpipe::tetmesh::fields
