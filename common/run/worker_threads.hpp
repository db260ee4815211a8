#pragma once

namespace hexpipe {

// Ends the threads that parallel loops have started; the next loop starts them again. For before fork(): a thread of
// the parent that holds a lock of the memory allocator at that moment leaves it locked in the child for ever (glibc's
// own allocator provides for this, those of sanitizers do not). Not from within a parallel loop.
void end_worker_threads();

}  // namespace hexpipe
