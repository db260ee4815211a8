#pragma once
// Small random moves of points, which keep lattices from being cospherical.

#include <cstdint>

#include "common/mesh/vec3.hpp"
#include "common/run/random.hpp"

namespace hexpipe::tetmesh::volume {

// Up to `reach` along each axis. It depends only on the seed and the point's number.
inline Vec3 jitter_of(std::size_t number, double reach, std::uint64_t seed) {
  Random random(seed, number);
  Vec3 jitter;
  jitter.x = random.uniform(-reach, reach);
  jitter.y = random.uniform(-reach, reach);
  jitter.z = random.uniform(-reach, reach);
  return jitter;
}

}  // namespace hexpipe::tetmesh::volume
