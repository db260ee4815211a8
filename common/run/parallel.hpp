#pragma once
// Parallel loops whose results do not depend on the number of threads: the size of the work alone decides how it is cut
// into blocks, and the results of blocks are put together in block order.

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace hexpipe {

// While an object exists, parallel loops use `threads` threads; 0 means all that the machine has.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

  // Keeps the limit until the process ends. If TBB could not start a thread for lack of memory, lifting the limit would
  // wait for ever.
  void stay();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

// The number of threads that parallel loops use now.
int thread_count();

// Scratch memory: each thread that asks for one gets a copy of `model`. Results must not depend on what earlier bodies
// left in it.
template <class T>
class PerThread {
 public:
  explicit PerThread(const T& model) : copies_(model) {}
  T& local() { return copies_.local(); }
  // Visits the copies in no particular order; results must not depend on it.
  template <class Visit>
  void for_each(Visit&& visit) {
    for (T& copy : copies_) visit(copy);
  }

 private:
  tbb::enumerable_thread_specific<T> copies_;
};

// Calls body(i) for i in [0, count), in any order. Each body writes to its own places.
template <class Body>
void parallel_for(std::int64_t count, std::int64_t grain, Body&& body) {
  if (count <= grain) {
    for (std::int64_t i = 0; i < count; ++i) body(i);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count, grain), [&](const auto& range) {
    for (std::int64_t i = range.begin(); i != range.end(); ++i) body(i);
  });
}

// Calls one() and other(), at the same time if there are threads for both. Neither may write what the other one reads.
template <class One, class Other>
void both_at_once(One&& one, Other&& other) {
  tbb::parallel_invoke(std::forward<One>(one), std::forward<Other>(other));
}

// Calls body(); its parallel loops leave one thread to another process, if there are more than one. A ThreadLimit would
// not do: where a thread cannot be started, lifting the limit ends the process.
template <class Body>
void leaving_one_thread(Body&& body) {
  tbb::task_arena(std::max(1, thread_count() - 1)).execute(std::forward<Body>(body));
}

// Cuts [0, count) into blocks of `block` items. Calls produce(begin, end) -> Product in parallel, and
// consume(Product&&) one at a time in block order. At most a few blocks per thread are held at once.
template <class Produce, class Consume>
void parallel_in_order(std::int64_t count, std::int64_t block, Produce&& produce, Consume&& consume) {
  using Product = decltype(produce(std::int64_t{}, std::int64_t{}));
  if (count <= block) {
    if (count > 0) consume(produce(std::int64_t{0}, count));
    return;
  }
  const std::size_t tokens = 4 * static_cast<std::size_t>(thread_count());
  // A block's product waits in slot (block number modulo tokens). Blocks leave in order, so the slot is free again by
  // then. Only a plain number flows through the pipeline, because oneTBB leaks the items in flight when a block throws.
  std::vector<std::optional<Product>> slots(tokens);
  const auto slot = [&](std::int64_t begin) -> std::optional<Product>& {
    return slots[static_cast<std::size_t>(begin / block) % tokens];
  };
  std::int64_t next = 0;
  const auto take = [&](tbb::flow_control& control) {
    const std::int64_t begin = next;
    if (begin >= count) control.stop();
    next = begin + block;
    return begin;
  };
  const auto make = [&](std::int64_t begin) {
    slot(begin).emplace(produce(begin, std::min(begin + block, count)));
    return begin;
  };
  const auto give = [&](std::int64_t begin) {
    consume(std::move(*slot(begin)));
    slot(begin).reset();
  };
  tbb::parallel_pipeline(tokens, tbb::make_filter<void, std::int64_t>(tbb::filter_mode::serial_in_order, take) &
                                     tbb::make_filter<std::int64_t, std::int64_t>(tbb::filter_mode::parallel, make) &
                                     tbb::make_filter<std::int64_t, void>(tbb::filter_mode::serial_in_order, give));
}

// Calls body(i, found) for i in [0, count), in blocks as above; it appends to `found`. Returns all in the order of i.
template <class T, class Body>
std::vector<T> parallel_collect(std::int64_t count, std::int64_t block, Body&& body) {
  std::vector<T> all;
  parallel_in_order(
      count, block,
      [&](std::int64_t begin, std::int64_t end) {
        std::vector<T> found;
        for (std::int64_t i = begin; i < end; ++i) body(i, found);
        return found;
      },
      [&](const std::vector<T>& found) { all.insert(all.end(), found.begin(), found.end()); });
  return all;
}

// Ends the threads that parallel loops have started; the next loop starts them again. Call it before fork(): if a
// thread of the parent holds a lock of the memory allocator at that moment, the lock stays taken in the child for ever.
// (glibc's own allocator takes care of this; those of the sanitizers do not.) Do not call it from within a parallel
// loop.
void end_worker_threads();

}  // namespace hexpipe
