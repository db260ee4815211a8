#include "common/run/parallel.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>

#include <utility>
#include <vector>

namespace hexpipe {

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{
          tbb::global_control(tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(threads > 0 ? threads : tbb::info::default_concurrency()))}) {}

ThreadLimit::~ThreadLimit() = default;

void ThreadLimit::stay() {
  // The list is never destroyed, not even at exit.
  static auto* const kept_limits = new std::vector<std::unique_ptr<Control>>;
  kept_limits->push_back(std::move(control_));
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void end_worker_threads() {
  tbb::task_scheduler_handle scheduler{tbb::attach{}};
  // False only if another thread is in a loop; then there is nothing to end.
  tbb::finalize(scheduler, std::nothrow);
}

}  // namespace hexpipe
