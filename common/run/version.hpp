#pragma once

namespace hexpipe {

// The version of hexpipe, "major.minor.patch".
const char* version();

}  // namespace hexpipe
