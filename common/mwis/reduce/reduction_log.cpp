#include "common/mwis/reduce/reduction_log.hpp"

#include <algorithm>

namespace hexpipe::mwis::reduce {

void ReductionLog::take(std::int32_t v) {
  begin_fold(v, 0);
}

void ReductionLog::begin_fold(std::int32_t v, std::int32_t created) {
  const std::size_t sets = ends_.size() - 1;
  steps_.push_back({v, created, sets, sets});
}

void ReductionLog::add_set(std::span<const std::int32_t> set) {
  members_.insert(members_.end(), set.begin(), set.end());
  ends_.push_back(members_.size());
  ++steps_.back().last_set;
}

void ReductionLog::forget(std::size_t size) {
  if (size == steps_.size()) return;
  ends_.resize(steps_[size].first_set + 1);
  members_.resize(ends_.back());
  steps_.resize(size);
}

void ReductionLog::lift(std::vector<std::uint8_t>& chosen) const {
  for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
    std::uint8_t* const created = chosen.data() + step->created;
    std::size_t i = step->first_set;
    while (i < step->last_set && created[i - step->first_set] == 0) ++i;
    if (i == step->last_set) {
      chosen[step->vertex] = 1;
      continue;
    }
    created[i - step->first_set] = 0;
    for (const std::int32_t v : set(i)) chosen[v] = 1;
  }
}

void ReductionLog::project(std::vector<std::uint8_t>& chosen) const {
  const auto is_chosen = [&](std::int32_t v) { return chosen[v] != 0; };
  for (const Step& step : steps_) {
    chosen[step.vertex] = 0;
    for (std::size_t i = step.first_set; i < step.last_set; ++i) {
      if (!std::ranges::all_of(set(i), is_chosen)) continue;
      for (const std::int32_t v : set(i)) chosen[v] = 0;
      chosen[step.created + static_cast<std::int32_t>(i - step.first_set)] = 1;
      break;
    }
  }
}

}  // namespace hexpipe::mwis::reduce
