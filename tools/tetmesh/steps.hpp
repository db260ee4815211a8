#pragma once
// The steps of a run, for a line of progress.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace hexpipe::tetmesh {

enum class Step { check, remesh, place, fill, follow_frames, fill_again, improve, write };

class StepReport {
 public:
  using Show = std::function<void(const std::string&)>;

  // `steps` are those that the run will have, in order. Without `show` nothing is reported.
  StepReport(std::vector<Step> steps, Show show) : steps_(std::move(steps)), show_(std::move(show)) {}

  // `count`: of the triangles, points or tets that the step works on.
  void begin(Step step, std::size_t count) const;

 private:
  std::vector<Step> steps_;
  Show show_;
};

}  // namespace hexpipe::tetmesh
