// Preloaded into a tool, makes one call of the system fail, as HEXPIPE_FAULT says:
//
//   KIND:N         the Nth call of this kind from main() on fails
//   disk:BYTES     files have room for this many bytes, all together; the last write is a short one
//   kill:N         SIGKILL at the Nth call of any kind
//   short:1        reads and writes move one byte less than asked, where that is more than none
//   exit:1         a library's destructor never ends
//   count:FILE     nothing fails; how many calls of each kind there were is written to FILE
//
// Kinds: open, read, write, close, link, rename, fork, thread, pipe, memory. After the fault everything works again,
// so that what the tool does about it is judged too.

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

enum Kind {
  open_call,
  read_call,
  write_call,
  close_call,
  link_call,
  rename_call,
  fork_call,
  thread_call,
  pipe_call,
  memory_call,
  kinds
};
constexpr const char* kind_names[kinds] = {"open",   "read", "write",  "close", "link",
                                           "rename", "fork", "thread", "pipe",  "memory"};

std::atomic<long> calls[kinds];
std::atomic<long> all_calls{0};
std::atomic<bool> in_main{false};
int failing_kind = -1;
long failing_number = -1;
long kill_number = -1;
bool short_counts = false;
bool waits_at_exit = false;
std::atomic<long> room_on_disk{-1};  // -1: without end
const char* count_file = nullptr;
pid_t tool = 0;

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool fails(Kind kind) {
  if (!in_main.load(std::memory_order_relaxed)) return false;
  const long number = calls[kind].fetch_add(1) + 1;
  // Allocations are too many and the same each time: a kill among them tells nothing more.
  if (kind != memory_call && all_calls.fetch_add(1) + 1 == kill_number && getpid() == tool) raise(SIGKILL);
  return kind == failing_kind && number == failing_number;
}

void read_fault(const char* fault) {
  const char* const colon = fault == nullptr ? nullptr : std::strchr(fault, ':');
  if (colon == nullptr) return;
  const auto is = [&](const char* word) {
    return std::strlen(word) == static_cast<std::size_t>(colon - fault) &&
           std::strncmp(fault, word, colon - fault) == 0;
  };
  const long number = std::atol(colon + 1);
  if (is("disk")) room_on_disk = number;
  if (is("kill")) kill_number = number;
  if (is("short")) short_counts = true;
  if (is("exit")) waits_at_exit = true;
  if (is("count")) count_file = colon + 1;
  for (int kind = 0; kind < kinds; ++kind)
    if (is(kind_names[kind])) failing_kind = kind, failing_number = number;
}

void write_counts() {
  in_main = false;
  if (count_file == nullptr || getpid() != tool) return;
  std::FILE* const file = std::fopen(count_file, "w");
  for (int kind = 0; kind < kinds; ++kind) std::fprintf(file, "%s %ld\n", kind_names[kind], calls[kind].load());
  std::fprintf(file, "kill %ld\n", all_calls.load());
  std::fclose(file);
}

// Less than `bytes` where the disk is full before or counts are short; -1 when nothing fits.
ssize_t allowed(int descriptor, std::size_t bytes) {
  if (short_counts && bytes > 1) return static_cast<ssize_t>(bytes - 1);
  struct stat status {};
  if (room_on_disk.load() < 0 || fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode))
    return static_cast<ssize_t>(bytes);
  const long room = room_on_disk.load();
  if (room == 0 && bytes > 0) return -1;
  const long taken = static_cast<long>(bytes) < room ? static_cast<long>(bytes) : room;
  room_on_disk -= taken;
  return taken;
}

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

int counted_main(int argc, char** argv, char** environment) {
  tool = getpid();
  read_fault(getenv("HEXPIPE_FAULT"));
  in_main = true;
  return real_main(argc, argv, environment);
}

__attribute__((destructor)) void wait_for_ever() {
  while (waits_at_exit) pause();
}

int failed(int error) {
  errno = error;
  return -1;
}

}  // namespace

extern "C" {

int __libc_start_main(Main program, int argc, char** argv, void (*init)(), void (*fini)(), void (*loader)(),
                      void* stack) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  real_main = program;
  return next<Start>("__libc_start_main")(counted_main, argc, argv, init, fini, loader, stack);
}

// Tools end by it: no handler that was registered before main() runs.
void _exit(int code) {
  static const auto real = next<void (*)(int)>("_exit");
  write_counts();
  real(code);
  __builtin_unreachable();
}

int open(const char* path, int flags, ...) {
  static const auto real = next<int (*)(const char*, int, ...)>("open");
  std::va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return fails(open_call) ? failed(EACCES) : real(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  static const auto real = next<int (*)(const char*, int, ...)>("open64");
  std::va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return fails(open_call) ? failed(EACCES) : real(path, flags, mode);
}

int mkostemp(char* path, int flags) {
  static const auto real = next<int (*)(char*, int)>("mkostemp");
  return fails(open_call) ? failed(EACCES) : real(path, flags);
}

ssize_t read(int descriptor, void* data, std::size_t bytes) {
  static const auto real = next<ssize_t (*)(int, void*, std::size_t)>("read");
  if (fails(read_call)) return failed(EIO);
  return real(descriptor, data, short_counts && bytes > 1 ? bytes - 1 : bytes);
}

ssize_t write(int descriptor, const void* data, std::size_t bytes) {
  static const auto real = next<ssize_t (*)(int, const void*, std::size_t)>("write");
  if (fails(write_call)) return failed(EIO);
  const ssize_t taken = allowed(descriptor, bytes);
  return taken < 0 ? failed(ENOSPC) : real(descriptor, data, static_cast<std::size_t>(taken));
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  static const auto real = next<ssize_t (*)(int, const iovec*, int)>("writev");
  if (fails(write_call)) return failed(EIO);
  std::size_t bytes = 0;
  for (int i = 0; i < count; ++i) bytes += parts[i].iov_len;
  const ssize_t taken = allowed(descriptor, bytes);
  return taken == static_cast<ssize_t>(bytes) ? real(descriptor, parts, count) : failed(ENOSPC);
}

// A close that fails has closed nevertheless, as in Linux.
int close(int descriptor) {
  static const auto real = next<int (*)(int)>("close");
  const bool told = fails(close_call);
  const int result = real(descriptor);
  return told ? failed(EIO) : result;
}

int rename(const char* from, const char* to) {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return fails(rename_call) ? failed(EXDEV) : real(from, to);
}

int linkat(int from_directory, const char* from, int to_directory, const char* to, int flags) {
  static const auto real = next<int (*)(int, const char*, int, const char*, int)>("linkat");
  return fails(link_call) ? failed(EACCES) : real(from_directory, from, to_directory, to, flags);
}

pid_t fork() {
  static const auto real = next<pid_t (*)()>("fork");
  return fails(fork_call) ? failed(EAGAIN) : real();
}

int pipe2(int ends[2], int flags) {
  static const auto real = next<int (*)(int*, int)>("pipe2");
  return fails(pipe_call) ? failed(EMFILE) : real(ends, flags);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto real = next<Create>("pthread_create");
  return fails(thread_call) ? EAGAIN : real(thread, attributes, run, argument);
}

void* malloc(std::size_t bytes) {
  return fails(memory_call) ? (errno = ENOMEM, nullptr) : __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) {
  return fails(memory_call) ? (errno = ENOMEM, nullptr) : __libc_calloc(count, bytes);
}

void* realloc(void* data, std::size_t bytes) {
  return fails(memory_call) ? (errno = ENOMEM, nullptr) : __libc_realloc(data, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  return fails(memory_call) ? (errno = ENOMEM, nullptr) : __libc_memalign(alignment, bytes);
}

int posix_memalign(void** data, std::size_t alignment, std::size_t bytes) {
  if (fails(memory_call)) return ENOMEM;
  *data = __libc_memalign(alignment, bytes);
  return *data == nullptr ? ENOMEM : 0;
}

}  // extern "C"
