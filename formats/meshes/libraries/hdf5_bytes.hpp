#pragma once
// HDF5 notes when each object of a file was made, and libraries on it have no switch against that; what they write into
// fields for text may end in what lay in their memory. The same mesh is to give the same bytes.

#include <string>

namespace hexpipe::formats {

// Clears both in a file, and makes the checksums anew. Throws std::exception.
void clear_hdf5_traces(const std::string& path);

}  // namespace hexpipe::formats
