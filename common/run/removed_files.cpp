#include "common/run/removed_files.hpp"

#include <unistd.h>

#include <atomic>
#include <climits>
#include <cstring>

namespace hexpipe {
namespace {

enum class State {
  unused,   // free for the next owner
  no_file,  // owned, and no file is named: the owner may write the path
  file,     // a file is named: a thread that ends the process may take it
  taken,    // taken for good: the process is ending
};

}  // namespace

struct RemovedFileSlot {
  std::atomic<State> state{State::no_file};
  RemovedFileSlot* next = nullptr;
  char path[PATH_MAX];
};

namespace {

static_assert(std::atomic<State>::is_always_lock_free && std::atomic<RemovedFileSlot*>::is_always_lock_free);

// Slots are reused but never freed, so that a signal handler can walk along them at any time.
std::atomic<RemovedFileSlot*> first_slot{nullptr};

bool change(RemovedFileSlot& slot, State from, State to) {
  return slot.state.compare_exchange_strong(from, to);
}

RemovedFileSlot* find_slot() {
  for (RemovedFileSlot* slot = first_slot; slot != nullptr; slot = slot->next)
    if (change(*slot, State::unused, State::no_file)) return slot;
  auto* const slot = new RemovedFileSlot;
  slot->next = first_slot;
  while (!first_slot.compare_exchange_weak(slot->next, slot)) {
  }
  return slot;
}

}  // namespace

RemovedFile::RemovedFile() : slot_(find_slot()) {}

RemovedFile::~RemovedFile() {
  change(*slot_, State::file, State::no_file);
  change(*slot_, State::no_file, State::unused);
}

void RemovedFile::set(const char* path) {
  change(*slot_, State::file, State::no_file);
  const std::size_t length = std::strlen(path);
  if (length == 0 || length >= sizeof slot_->path || slot_->state != State::no_file) return;
  std::memcpy(slot_->path, path, length + 1);
  slot_->state = State::file;
}

void remove_registered_files() {
  for (RemovedFileSlot* slot = first_slot; slot != nullptr; slot = slot->next)
    if (change(*slot, State::file, State::taken) && unlink(slot->path) != 0) rmdir(slot->path);
}

}  // namespace hexpipe
