#pragma once
// OpenCASCADE crashes on some broken files. Users then get the one line that they get about other bad files.

#include <string_view>

namespace hexpipe::tessellate {

// While it lives, a crash of this process writes "tessellate: FILE: OpenCASCADE crashed on it" and ends with exit
// code 1. One at a time. Under the address sanitizer it does nothing, because that tells more.
class CrashMessage {
 public:
  explicit CrashMessage(std::string_view file);
  ~CrashMessage();
  CrashMessage(const CrashMessage&) = delete;
  CrashMessage& operator=(const CrashMessage&) = delete;
};

}  // namespace hexpipe::tessellate
