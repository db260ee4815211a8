#pragma once
// Says in the line of progress what a search has chosen: hexes, the share of the volume that they fill, and how far
// that can be from the best choice.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "common/graph/conflict_graph.hpp"
#include "common/run/deadline.hpp"
#include "common/run/progress.hpp"
#include "formats/pipeline/stage_data.hpp"

namespace hexpipe::pipeline {

class ChoiceProgress {
 public:
  // `data` was read with StageRequest::volumes and outlives this. `graph_of_bundle`: bounds in the history are those of
  // the graph.
  ChoiceProgress(Step& step, const StageData& data, bool graph_of_bundle);

  // Calls solution() where the line is due, and seldom if that takes long.
  void show(std::int64_t weight, const std::function<graph::IndependentSet()>& solution);

 private:
  std::string text_of(std::int64_t weight, const graph::IndependentSet& chosen) const;

  Step& step_;
  const CandidateVolumes& volumes_;
  double mesh_volume_ = 0;  // 0: not known
  std::optional<std::int64_t> bound_;
  std::int64_t of_quads_ = 0;  // what their vertices weigh, which is no gain
  Stopwatch watch_;
  double next_ = 0;
};

}  // namespace hexpipe::pipeline
