// Conjugate gradients on the normal equations. Ray, Li, Lévy, Sheffer, Alliez: Periodic global parameterization (2006),
// section 4.3, and Sokolov, Ray, Untereiner, Lévy: Hexahedral-Dominant Meshing (2016), section 4.3, correct the curl of
// a field for the same purpose, before they look for periodic coordinates along it.

#include "tools/tetmesh/fields/curl_correction.hpp"

namespace hexpipe::tetmesh::fields {
namespace {

// Single precision is enough for the tolerance, and the speed depends on the amount of memory that is read.
using Numbers = std::vector<float>;

double dot(const Numbers& a, const Numbers& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * b[i];
  return sum;
}

float sum_along(std::span<const std::int32_t> loop, const Numbers& value) {
  float sum = 0;
  for (const std::int32_t step : loop) sum += step < 0 ? -value[~step] : value[step];
  return sum;
}

void add_along(std::span<const std::int32_t> loop, float sum, Numbers& image) {
  for (const std::int32_t step : loop) (step < 0 ? image[~step] : image[step]) += step < 0 ? -sum : sum;
}

}  // namespace

std::vector<float> curl_correction(std::span<const float> distances, const Loops& loops, const CurlLimits& limits) {
  const std::size_t count = distances.size();
  Numbers correction(count), rest(count), image(count);
  Numbers direction(distances.begin(), distances.end());
  for (std::size_t i = 0; i < loops.size(); ++i)
    add_along(loops[i], loops.sum_of(i) - sum_along(loops[i], direction), rest);
  direction = rest;
  double product = dot(rest, rest);
  const double enough = limits.tolerance * limits.tolerance * product;
  for (int k = 0; k < limits.most_iterations && product > enough; ++k) {
    for (std::size_t i = 0; i < count; ++i) image[i] = limits.stiffness * direction[i];
    for (std::size_t i = 0; i < loops.size(); ++i) add_along(loops[i], sum_along(loops[i], direction), image);
    const auto step = static_cast<float>(product / dot(direction, image));
    for (std::size_t i = 0; i < count; ++i) {
      correction[i] += step * direction[i];
      rest[i] -= step * image[i];
    }
    const double next = dot(rest, rest);
    const auto onward = static_cast<float>(next / product);
    for (std::size_t i = 0; i < count; ++i) direction[i] = rest[i] + onward * direction[i];
    product = next;
  }
  return correction;
}

}  // namespace hexpipe::tetmesh::fields
