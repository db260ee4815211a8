#pragma once
// Files, and empty folders, that are to be gone when the process ends without destructors: by a signal, or where memory
// is missing.

namespace hexpipe {

struct RemovedFileSlot;

// Holds the name of one file. What ends the process may come at any time and on any thread.
class RemovedFile {
 public:
  // No file yet. Memory is taken here, so that names can be set when there is none left.
  RemovedFile();
  // The file stays.
  ~RemovedFile();
  RemovedFile(const RemovedFile&) = delete;
  RemovedFile& operator=(const RemovedFile&) = delete;

  // In place of the one before; empty: none. Paths longer than the system's limit name no file and are not kept.
  void set(const char* path);

 private:
  RemovedFileSlot* slot_;
};

// Removes the files of all there are. May be called by a signal handler.
void remove_registered_files();

}  // namespace hexpipe
