#pragma once
// Checks the header of a classic NetCDF file. The library believes every number in it, and takes minutes and gigabytes
// for wrong ones.

#include <string>
#include <string_view>

namespace hexpipe::formats {

bool looks_like_classic_netcdf(std::string_view bytes);

// Throws DataError, beginning with `name`, where lists are longer than the file, or data end behind it.
void check_netcdf_header(std::string_view bytes, const std::string& name);

}  // namespace hexpipe::formats
