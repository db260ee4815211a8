#pragma once
// A mesh may have more parts than the number of files that a process may open without asking for more.

namespace hexpipe {

// Raises the limit as far as the system allows.
void allow_many_open_files();

}  // namespace hexpipe
