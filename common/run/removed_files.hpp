#pragma once
// Files and empty folders to remove when the process ends without destructors: by a signal, or for lack of memory.

namespace hexpipe {

struct RemovedFileSlot;

// Holds the name of one file. The process may end at any time and on any thread.
class RemovedFile {
 public:
  // Names no file yet. It takes its memory here, so that naming a file works when memory is exhausted.
  RemovedFile();
  // The file stays.
  ~RemovedFile();
  RemovedFile(const RemovedFile&) = delete;
  RemovedFile& operator=(const RemovedFile&) = delete;

  // Replaces the former name; an empty path names no file. Paths longer than the system's limit cannot exist and are
  // ignored.
  void set(const char* path);

 private:
  RemovedFileSlot* slot_;
};

// Removes the files of all objects. A signal handler may call it.
void remove_registered_files();

}  // namespace hexpipe
