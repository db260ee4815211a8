#include "common/mwis/exact/packing_program.hpp"

#include <ClpEventHandler.hpp>
#include <ClpSimplex.hpp>
#include <algorithm>

namespace hexpipe::mwis::exact {
namespace {

// The simplex calls this after each iteration.
class StopAtDeadline : public ClpEventHandler {
 public:
  explicit StopAtDeadline(const Deadline& deadline) : deadline_(&deadline) {}
  int event(Event event) override { return event == endOfIteration && deadline_->passed() ? 0 : -1; }
  ClpEventHandler* clone() const override { return new StopAtDeadline(*this); }

 private:
  const Deadline* deadline_;
};

}  // namespace

class PackingProgram::Simplex {
 public:
  explicit Simplex(std::span<const std::int64_t> weights) {
    model_.setLogLevel(0);
    model_.resize(0, static_cast<int>(weights.size()));
    for (std::size_t v = 0; v < weights.size(); ++v) {
      model_.setObjectiveCoefficient(static_cast<int>(v), -static_cast<double>(weights[v]));
      model_.setColumnBounds(static_cast<int>(v), 0, 1);
    }
  }

  void add_row(std::span<const std::int32_t> clique) {
    members_.insert(members_.end(), clique.begin(), clique.end());
    offsets_.push_back(static_cast<CoinBigIndex>(members_.size()));
  }

  // Starts from the last basis: with more rows, it is still valid for the dual simplex.
  bool solve(const Deadline& deadline) {
    add_waiting_rows();
    const StopAtDeadline handler(deadline);
    model_.passInEventHandler(&handler);
    return model_.dual() == 0;
  }

  std::span<const double> values() const {
    return {model_.primalColumnSolution(), static_cast<std::size_t>(model_.numberColumns())};
  }
  std::span<const double> prices() const {
    return {model_.dualRowSolution(), static_cast<std::size_t>(model_.numberRows())};
  }

 private:
  void add_waiting_rows() {
    const std::size_t rows = offsets_.size() - 1;
    const std::vector<double> low(rows, -COIN_DBL_MAX), high(rows, 1.0), ones(members_.size(), 1.0);
    model_.addRows(static_cast<int>(rows), low.data(), high.data(), offsets_.data(), members_.data(), ones.data());
    offsets_.assign(1, 0);
    members_.clear();
  }

  ClpSimplex model_;
  std::vector<CoinBigIndex> offsets_{0};  // of rows that still have to be added
  std::vector<int> members_;
};

PackingProgram::PackingProgram(std::span<const std::int64_t> weights) : simplex_(std::make_unique<Simplex>(weights)) {}
PackingProgram::~PackingProgram() = default;

void PackingProgram::add_row(std::span<const std::int32_t> clique) {
  simplex_->add_row(clique);
}

bool PackingProgram::solve(const Deadline& deadline) {
  const bool optimal = simplex_->solve(deadline);
  fractions_.assign(simplex_->values().begin(), simplex_->values().end());
  for (double& fraction : fractions_) fraction = std::clamp(fraction, 0.0, 1.0);
  prices_.assign(simplex_->prices().begin(), simplex_->prices().end());
  // CLP minimizes, so its prices are negative.
  for (double& price : prices_) price = std::max(0.0, -price);
  return optimal;
}

}  // namespace hexpipe::mwis::exact
