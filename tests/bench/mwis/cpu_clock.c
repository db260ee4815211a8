// Preloaded into a solver by run.py: its clocks run at the pace of the CPU time that its threads use, divided by their
// number, so that a time limit means the same for every solver, however busy the machine is.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <sys/time.h>
#include <time.h>

static int (*real_clock_gettime)(clockid_t, struct timespec *);
static long threads = 1;

__attribute__((constructor)) static void prepare(void) {
  real_clock_gettime = (int (*)(clockid_t, struct timespec *))dlsym(RTLD_NEXT, "clock_gettime");
  const char *const text = getenv("CPU_CLOCK_THREADS");
  if (text != NULL && atol(text) > 0) threads = atol(text);
}

int clock_gettime(clockid_t clock, struct timespec *time) {
  if (real_clock_gettime == NULL) prepare();
  const int wall = clock == CLOCK_MONOTONIC || clock == CLOCK_REALTIME || clock == CLOCK_MONOTONIC_RAW;
  const int result = real_clock_gettime(wall ? CLOCK_PROCESS_CPUTIME_ID : clock, time);
  if (wall && result == 0) {
    const long long nanoseconds = (time->tv_sec * 1000000000LL + time->tv_nsec) / threads;
    // Far from zero, because some programs take a time of zero for none.
    time->tv_sec = nanoseconds / 1000000000 + 1000000;
    time->tv_nsec = nanoseconds % 1000000000;
  }
  return result;
}

int gettimeofday(struct timeval *restrict time, void *restrict zone) {
  (void)zone;
  struct timespec now;
  const int result = clock_gettime(CLOCK_REALTIME, &now);
  time->tv_sec = now.tv_sec;
  time->tv_usec = now.tv_nsec / 1000;
  return result;
}
