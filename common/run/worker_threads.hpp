#pragma once

namespace hexpipe {

// Ends the threads that parallel loops have started; the next loop starts them again. Call it before fork(): if a
// thread of the parent holds a lock of the memory allocator at that moment, the lock stays taken in the child for ever.
// (glibc's own allocator takes care of this; those of the sanitizers do not.) Do not call it from within a parallel
// loop.
void end_worker_threads();

}  // namespace hexpipe
