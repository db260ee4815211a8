#include "common/run/worker_threads.hpp"

#include <oneapi/tbb/global_control.h>

#include <new>

namespace hexpipe {

void end_worker_threads() {
  tbb::task_scheduler_handle scheduler{tbb::attach{}};
  // False only if another thread is in a loop; then there is nothing to end.
  tbb::finalize(scheduler, std::nothrow);
}

}  // namespace hexpipe
