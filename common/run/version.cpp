#include "common/run/version.hpp"

namespace hexpipe {

const char* version() {
  return HEXPIPE_VERSION;
}

}  // namespace hexpipe
