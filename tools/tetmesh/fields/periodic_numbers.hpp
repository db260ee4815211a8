#pragma once
// Periodic coordinates on the nodes of a surface or a volume: K complex numbers a node, exp(2 pi i coordinate), that
// turn by the distance from one node to the next (Ray, Li, Lévy, Sheffer, Alliez: Periodic global parameterization,
// 2006). This file spreads them from where they are held. The caller says how a node sees its neighbours.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace hexpipe::tetmesh::fields {

using Complex = std::complex<double>;
template <std::size_t K>
using PeriodicNumbers = std::vector<std::array<Complex, K>>;

// The real and the imaginary part, which the processor adds and multiplies at once.
using ComplexParts = Eigen::Array2d;

inline ComplexParts parts_of(const Complex& z) {
  return Eigen::Map<const ComplexParts>(reinterpret_cast<const double*>(&z));  // as the standard allows
}
inline Complex complex_of(const ComplexParts& parts) {
  return {parts[0], parts[1]};
}

// Without the standard's care for infinities, which costs more than the product itself.
inline Complex times(const Complex& a, const Complex& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

inline Complex unit(const Complex& z) {
  const double modulus = std::sqrt(std::norm(z));  // std::abs takes longer, because it guards against overflow
  return modulus > 0 ? z / modulus : Complex(1);
}

inline double scalar_product(const Complex& a, const Complex& b) {
  return a.real() * b.real() + a.imag() * b.imag();
}

template <std::size_t K>
double product(const PeriodicNumbers<K>& a, const PeriodicNumbers<K>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < K; ++k) sum += scalar_product(a[i][k], b[i][k]);
  return sum;
}

inline Complex number_at(double coordinate) {
  return std::polar(1.0, 2 * std::numbers::pi * coordinate);
}

// From -1/2 to 1/2.
inline double coordinate_of(const Complex& number) {
  return std::arg(number) / (2 * std::numbers::pi);
}

inline constexpr double inertia = 0.3;  // of a number's own value, against its links

// Sets each number to the mean of what links and what holds it say, all at once from the numbers before, so that the
// order of the nodes does not count, and goes beyond that mean, away from the sweep before (the second-order iteration
// of Richardson). So 20 sweeps smooth as far as 60 without that: on eleven models at two sizes hexes have 96.61 % of
// the volume and 78.7 % of the number, with 60 plain ones 96.66 and 78.4, with 30 plain ones 96.44 and 78.0.
// view(numbers, node) is the weighted sum of the neighbours' numbers, degree(node) the weight of all links, and
// held(node, k) what holds number k, times its weight. for_each(body) calls body(node) for all nodes in parallel.
template <std::size_t K, class ForEach, class View, class Degree, class Held>
void smooth(PeriodicNumbers<K>& numbers, int sweeps, ForEach&& for_each, View&& view, Degree&& degree, Held&& held) {
  constexpr double reach = 1.5;  // beyond the mean, from the sweep before
  PeriodicNumbers<K> before = numbers;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for_each([&](std::size_t i) {
      const std::array<Complex, K> seen = view(numbers, i);
      for (std::size_t k = 0; k < K; ++k) {
        const Complex mean = unit(seen[k] + inertia * degree(i) * numbers[i][k] + held(i, k));
        before[i][k] = sweep == 0 ? mean : unit(reach * mean + (1 - reach) * before[i][k]);
      }
    });
    numbers.swap(before);
  }
}

struct DiffusionLimits {
  int iterations;
  double tolerance;  // the residual at which the solver ends, as a share of that at the start
};

// Minimizes the quadratic energy of differences along links and from the held numbers, by conjugate gradients,
// preconditioned by the diagonal. `rest` is the held numbers times their weights. for_each(body) calls body(node) for
// all nodes in parallel. diagonal(node, k) is the weight of all links and of the hold on number k. view(numbers, node)
// is the weighted sum of the neighbours' numbers, as the node sees them. product(a, b) is the scalar product. The
// iteration starts from zeros.
template <std::size_t K, class ForEach, class Diagonal, class View, class Product>
PeriodicNumbers<K> diffused(PeriodicNumbers<K> rest, const DiffusionLimits& limits, ForEach&& for_each,
                            Diagonal&& diagonal, View&& view, Product&& product) {
  PeriodicNumbers<K> numbers(rest.size()), z(rest.size()), image(rest.size());
  const auto precondition = [&](std::size_t i, std::size_t k) { z[i][k] = rest[i][k] / diagonal(i, k); };
  for_each([&](std::size_t i) {
    for (std::size_t k = 0; k < K; ++k) precondition(i, k);
  });
  PeriodicNumbers<K> direction = z;
  double rest_z = product(rest, z);
  const double enough = limits.tolerance * limits.tolerance * rest_z;
  for (int step = 0; step < limits.iterations && rest_z > enough; ++step) {
    for_each([&](std::size_t i) {
      const std::array<Complex, K> seen = view(direction, i);
      for (std::size_t k = 0; k < K; ++k) image[i][k] = diagonal(i, k) * direction[i][k] - seen[k];
    });
    const double length = rest_z / product(direction, image);
    for_each([&](std::size_t i) {
      for (std::size_t k = 0; k < K; ++k) {
        numbers[i][k] += length * direction[i][k];
        rest[i][k] -= length * image[i][k];
        precondition(i, k);
      }
    });
    const double next = product(rest, z), ratio = next / rest_z;
    for_each([&](std::size_t i) {
      for (std::size_t k = 0; k < K; ++k) direction[i][k] = z[i][k] + ratio * direction[i][k];
    });
    rest_z = next;
  }
  return numbers;
}

template <std::size_t K, class ForEach, class Diagonal, class View>
PeriodicNumbers<K> diffused(PeriodicNumbers<K> rest, const DiffusionLimits& limits, ForEach&& for_each,
                            Diagonal&& diagonal, View&& view) {
  return diffused<K>(std::move(rest), limits, for_each, diagonal, view, product<K>);
}

}  // namespace hexpipe::tetmesh::fields
