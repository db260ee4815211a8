#include "tools/tetmesh/fields/whole_number_program.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace hexpipe::tetmesh::fields {
namespace {

// More free unknowns take too long.
constexpr std::size_t most_unknowns = 800;
// That part of them is rounded at once.
constexpr std::size_t rounded_at_once = 100;
constexpr double least_weight = 1e-9;  // so that each system has one solution
constexpr double least_gain = 1e-9;

void add_multiple(const WholeEquation& from, std::int32_t factor, WholeEquation& to) {
  for (const auto& [unknown, own] : from)
    if ((to[unknown] += factor * own) == 0) to.erase(unknown);
}

// Puts what is known of an unknown in its place.
void substitute(std::int32_t unknown, const WholeEquation& known, WholeEquation& equation) {
  const auto found = equation.find(unknown);
  if (found == equation.end()) return;
  const std::int32_t factor = found->second;
  equation.erase(found);
  add_multiple(known, factor, equation);
}

}  // namespace

WholeNumberProgram::WholeNumberProgram(std::vector<WholeEquation> equations, std::vector<double> wanted,
                                       std::vector<double> weights)
    : equations_(std::move(equations)), wanted_(std::move(wanted)), weights_(std::move(weights)) {}

std::optional<std::vector<double>> WholeNumberProgram::relax() {
  eliminate();
  describe_by_free();
  if (static_cast<std::size_t>(by_free_.cols()) > most_unknowns) return std::nullopt;
  const Eigen::Map<const Vector> weights(weights_.data(), by_free_.rows()), wanted(wanted_.data(), by_free_.rows());
  energy_ = by_free_.transpose() * weights.asDiagonal() * by_free_;
  energy_.diagonal().array() += least_weight;
  pull_ = by_free_.transpose() * weights.cwiseProduct(wanted);
  relaxed_ = energy_.ldlt().solve(pull_);
  const Vector values = by_free_ * relaxed_;
  return std::vector<double>(values.begin(), values.end());
}

std::vector<std::int32_t> WholeNumberProgram::round() const {
  Vector free = relaxed_;
  round_surest(free);
  improve(free);
  std::vector<std::int32_t> result;
  for (const double value : Vector(by_free_ * free)) result.push_back(static_cast<std::int32_t>(std::lround(value)));
  return result;
}

bool WholeNumberProgram::drop_worst_of(std::int32_t unknown) {
  auto worst = equations_.end();
  for (auto e = equations_.begin(); e != equations_.end(); ++e)
    if (e->contains(unknown) && (worst == equations_.end() || missed_by(*e) > missed_by(*worst))) worst = e;
  if (worst == equations_.end()) return false;
  equations_.erase(worst);
  return true;
}

// Nothing where an unknown that may be anything makes up for it.
double WholeNumberProgram::missed_by(const WholeEquation& equation) const {
  double sum = 0;
  for (const auto& [unknown, factor] : equation) {
    if (unknown >= wanted_count()) return 0;
    sum += factor * wanted_[unknown];
  }
  return std::abs(sum);
}

void WholeNumberProgram::eliminate() {
  solved_.clear();
  std::erase_if(equations_, [&](const WholeEquation& equation) { return !solve_for_one(equation); });
}

bool WholeNumberProgram::solve_for_one(WholeEquation equation) {
  for (const auto& [unknown, known] : solved_) substitute(unknown, known, equation);
  std::int32_t divisor = 0;
  for (const auto& [unknown, factor] : equation) divisor = std::gcd(divisor, factor);
  const auto one = std::ranges::find_if(equation, [&](const auto& term) { return std::abs(term.second) == divisor; });
  if (one == equation.end()) return equation.empty();
  const std::int32_t unknown = one->first, sign = one->second / divisor;
  equation.erase(one);
  for (auto& [other, factor] : equation) factor /= -sign * divisor;
  for (auto& [other, known] : solved_) substitute(unknown, equation, known);
  solved_[unknown] = std::move(equation);
  return true;
}

void WholeNumberProgram::describe_by_free() {
  std::int32_t last = wanted_count();
  for (const auto& [unknown, known] : solved_)
    if (!known.empty()) last = std::max(last, known.rbegin()->first + 1);
  std::map<std::int32_t, Eigen::Index> column;
  for (std::int32_t unknown = 0; unknown < last; ++unknown)
    if (!solved_.contains(unknown)) column.emplace(unknown, static_cast<Eigen::Index>(column.size()));
  by_free_ = Matrix::Zero(wanted_count(), static_cast<Eigen::Index>(column.size()));
  for (std::int32_t unknown = 0; unknown < wanted_count(); ++unknown)
    if (const auto found = solved_.find(unknown); found == solved_.end())
      by_free_(unknown, column.at(unknown)) = 1;
    else
      for (const auto& [other, factor] : found->second) by_free_(unknown, column.at(other)) = factor;
}

// Those that are left are found again each time.
void WholeNumberProgram::round_surest(Vector& free) const {
  std::vector<Eigen::Index> left(static_cast<std::size_t>(free.size()));
  std::iota(left.begin(), left.end(), Eigen::Index{0});
  while (!left.empty()) {
    std::ranges::stable_sort(left, {}, [&](Eigen::Index i) { return std::abs(free[i] - std::round(free[i])); });
    const auto count = static_cast<std::ptrdiff_t>(1 + left.size() / rounded_at_once);
    for (auto i = left.begin(); i != left.begin() + count; ++i) free[*i] = std::round(free[*i]);
    left.erase(left.begin(), left.begin() + count);
    const Vector known = free(left), of_all = energy_ * free;
    const Matrix energy = energy_(left, left);
    const Vector pull = pull_(left) - of_all(left) + energy * known;
    free(left) = Vector(energy.ldlt().solve(pull));
  }
}

// Steps of one, up or down, as long as one helps.
void WholeNumberProgram::improve(Vector& free) const {
  for (bool is_better = true; is_better;) {
    is_better = false;
    for (Eigen::Index i = 0; i < free.size(); ++i) {
      const double slope = energy_.row(i).dot(free) - pull_[i], step = slope > 0 ? -1 : 1;
      if (energy_(i, i) - 2 * std::abs(slope) > -least_gain) continue;
      free[i] += step;
      is_better = true;
    }
  }
}

}  // namespace hexpipe::tetmesh::fields
