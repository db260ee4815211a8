#pragma once
// How many random cases a test tries.

namespace hexpipe::testing {

// All of them where the code is optimized; a fifth under the address sanitizer, where each takes many times as long and
// runs through the same lines.
constexpr int random_cases(int optimized) {
#ifdef __SANITIZE_ADDRESS__
  return optimized / 5;
#else
  return optimized;
#endif
}

}  // namespace hexpipe::testing
