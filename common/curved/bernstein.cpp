#include "common/curved/bernstein.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hexpipe::curved {
namespace {

constexpr double factorial(int n) {
  return n < 2 ? 1 : n * factorial(n - 1);
}

// Appends all exponents of one simplex, from coordinate `at` on, to those of the simplices before it.
void add_exponents(Exponents exponents, int at, int end, int left, std::vector<Exponents>& all) {
  if (at + 1 == end) {
    exponents[at] = static_cast<std::uint8_t>(left);
    all.push_back(exponents);
    return;
  }
  for (int degree = left; degree >= 0; --degree) {
    exponents[at] = static_cast<std::uint8_t>(degree);
    add_exponents(exponents, at + 1, end, left - degree, all);
  }
}

Exponents sum(const Exponents& a, const Exponents& b) {
  Exponents result;
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = static_cast<std::uint8_t>(a[i] + b[i]);
  return result;
}

// De Casteljau: `low` becomes the coefficients on the first half of a line, `high` those on the second.
void halve(const BernsteinBasis::Line& line, std::vector<double>& low, std::vector<double>& high) {
  for (std::size_t level = 1; level < line.size(); ++level) {
    for (std::size_t i = line.size() - 1; i >= level; --i) {
      // In place, from the end of the line, as low keeps the first coefficient of each level.
      low[line[i]] = 0.5 * (low[line[i - 1]] + low[line[i]]);
    }
    high[line[line.size() - 1 - level]] = low[line.back()];
  }
}

// How far the coefficients along an edge are from lines.
double bend(const std::vector<BernsteinBasis::Line>& edge, const std::vector<double>& coefficients) {
  double result = 0;
  for (const BernsteinBasis::Line& line : edge)
    for (std::size_t i = 2; i < line.size(); ++i)
      result =
          std::max(result, std::abs(coefficients[line[i]] - 2 * coefficients[line[i - 1]] + coefficients[line[i - 2]]));
  return result;
}

}  // namespace

BernsteinBasis::BernsteinBasis(std::vector<Simplex> simplices) : simplices_(std::move(simplices)) {
  std::vector<Exponents> all{Exponents{}};
  int at = 0;
  for (const Simplex& simplex : simplices_) {
    std::vector<Exponents> more;
    for (const Exponents& exponents : all) add_exponents(exponents, at, at + simplex.coordinates, simplex.degree, more);
    all = std::move(more);
    at += simplex.coordinates;
  }
  exponents_ = std::move(all);
  for (std::size_t i = 0; i < exponents_.size(); ++i) index_[exponents_[i]] = static_cast<std::int32_t>(i);
  find_corners();
  find_edges();
}

void BernsteinBasis::find_corners() {
  for (std::size_t i = 0; i < exponents_.size(); ++i) {
    bool is_corner = true;
    int at = 0;
    for (const Simplex& simplex : simplices_) {
      const auto begin = exponents_[i].begin() + at;
      is_corner = is_corner && *std::max_element(begin, begin + simplex.coordinates) == simplex.degree;
      at += simplex.coordinates;
    }
    if (is_corner) corners_.push_back(static_cast<std::int32_t>(i));
  }
}

void BernsteinBasis::find_edges() {
  int at = 0;
  for (const Simplex& simplex : simplices_) {
    for (int p = at; p < at + simplex.coordinates; ++p)
      for (int q = p + 1; q < at + simplex.coordinates; ++q) {
        std::vector<Line> lines;
        for (Exponents exponents : exponents_) {
          if (exponents[q] > 0 || exponents[p] == 0) continue;
          Line line{index_of(exponents)};
          while (exponents[p] > 0) {
            --exponents[p], ++exponents[q];
            line.push_back(index_of(exponents));
          }
          lines.push_back(std::move(line));
        }
        edges_.push_back(std::move(lines));
      }
    at += simplex.coordinates;
  }
}

double BernsteinBasis::multinomial(const Exponents& exponents) const {
  double result = 1;
  int at = 0;
  for (const Simplex& simplex : simplices_) {
    result *= factorial(simplex.degree);
    for (int i = at; i < at + simplex.coordinates; ++i) result /= factorial(exponents[i]);
    at += simplex.coordinates;
  }
  return result;
}

BernsteinBasis product_basis(const BernsteinBasis& a, const BernsteinBasis& b) {
  auto simplices = a.simplices();
  for (std::size_t i = 0; i < simplices.size(); ++i) simplices[i].degree += b.simplices()[i].degree;
  return BernsteinBasis(std::move(simplices));
}

std::vector<ProductTerm> product_terms(const BernsteinBasis& a, const BernsteinBasis& b,
                                       const BernsteinBasis& product) {
  std::vector<ProductTerm> terms;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) {
      const Exponents exponents = sum(a.exponents(i), b.exponents(j));
      terms.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), product.index_of(exponents),
                       a.multinomial(a.exponents(i)) * b.multinomial(b.exponents(j)) / product.multinomial(exponents)});
    }
  return terms;
}

bool is_above(const BernsteinBasis& basis, std::span<const double> coefficients, double least) {
  std::vector<std::vector<double>> open{{coefficients.begin(), coefficients.end()}};
  int halvings = 0;
  while (!open.empty()) {
    std::vector<double> low = std::move(open.back());
    open.pop_back();
    // `not` is there for NaN, which is above nothing.
    for (const std::int32_t corner : basis.corners())
      if (!(low[corner] > least)) return false;
    if (std::ranges::all_of(low, [&](double coefficient) { return coefficient > least; })) continue;
    if (++halvings > most_halvings) return false;
    double most = -1;
    const std::vector<BernsteinBasis::Line>* widest = nullptr;
    for (const auto& edge : basis.edges())
      if (const double here = bend(edge, low); here > most) most = here, widest = &edge;
    std::vector<double> high = low;
    for (const BernsteinBasis::Line& line : *widest) halve(line, low, high);
    open.push_back(std::move(low));
    open.push_back(std::move(high));
  }
  return true;
}

}  // namespace hexpipe::curved
