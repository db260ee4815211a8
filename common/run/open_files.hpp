#pragma once
// Parts of a mesh may be more than the files that a process may have open until it asks for more.

namespace hexpipe {

// As many as the system lets us.
void allow_many_open_files();

}  // namespace hexpipe
