#pragma once
// Random numbers that are the same on every machine; the standard library's distributions and shuffle are not. The
// generator is xoshiro256** (Blackman and Vigna 2018), seeded by splitmix64. Bounded draws follow Lemire 2019.

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>

namespace hexpipe {

// The finalizer of splitmix64 (Steele, Lea, Flood 2014): it is one to one, and every bit of x changes every bit of the
// result.
constexpr std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

class Random {
 public:
  explicit Random(std::uint64_t seed) {
    for (auto& word : state_) word = splitmix(seed);
  }
  // An independent stream for each `index` of a computation whose steps can run in any order.
  Random(std::uint64_t seed, std::uint64_t index) : Random(seed ^ (0x9e3779b97f4a7c15u * (index + 1))) {}

  std::uint64_t next() {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  // Uniform in [0, bound), bound > 0, without bias.
  std::uint64_t below(std::uint64_t bound) {
    auto product = static_cast<Wide>(next()) * bound;
    if (static_cast<std::uint64_t>(product) < bound) {
      const std::uint64_t threshold = (0 - bound) % bound;
      while (static_cast<std::uint64_t>(product) < threshold) product = static_cast<Wide>(next()) * bound;
    }
    return static_cast<std::uint64_t>(product >> 64);
  }

  // Uniform in [0, 1): a multiple of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  // The Fisher-Yates shuffle.
  template <class T>
  void shuffle(std::span<T> items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  __extension__ using Wide = unsigned __int128;

  static std::uint64_t splitmix(std::uint64_t& x) { return mix(x += 0x9e3779b97f4a7c15u); }

  std::array<std::uint64_t, 4> state_;
};

}  // namespace hexpipe
