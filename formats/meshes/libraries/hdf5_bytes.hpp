#pragma once
// The same mesh has to give the same bytes. But HDF5 notes when each object of a file was made, and the libraries that
// use it have no switch against that. They also write fields for text that may end in old bytes of their memory.

#include <string>

namespace hexpipe::formats {

// Clears both in a file, and makes the checksums anew. Throws std::exception.
void clear_hdf5_traces(const std::string& path);

}  // namespace hexpipe::formats
