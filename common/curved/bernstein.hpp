#pragma once
// Polynomials on cubes, prisms and tets as coefficients of Bernstein's basis: the least coefficient is a lower bound of
// the polynomial, and coefficients at corners are its values there.
//
// A domain is a product of simplices: a cube of three segments, a prism of a triangle and a segment, a tet of itself
// alone. A term of the basis is named by the exponents of the barycentric coordinates of all simplices.

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace hexpipe::curved {

// The barycentric coordinates of all simplices of a domain, one after the other.
using Exponents = std::array<std::uint8_t, 6>;

class BernsteinBasis {
 public:
  // For each simplex, how many barycentric coordinates it has, and the degree in them.
  struct Simplex {
    int coordinates, degree;
  };
  explicit BernsteinBasis(std::vector<Simplex> simplices);

  std::size_t size() const { return exponents_.size(); }
  const Exponents& exponents(std::size_t term) const { return exponents_[term]; }
  std::int32_t index_of(const Exponents& exponents) const { return index_.at(exponents); }
  const std::vector<Simplex>& simplices() const { return simplices_; }

  // Coefficients that are values: those at the corners of the domain.
  std::span<const std::int32_t> corners() const { return corners_; }

  // An edge of a simplex, along which the domain can be halved. Each line of coefficients is a polynomial of one
  // variable along the edge.
  using Line = std::vector<std::int32_t>;
  const std::vector<std::vector<Line>>& edges() const { return edges_; }

  // Multinomial coefficients of a term, multiplied over the simplices.
  double multinomial(const Exponents& exponents) const;

 private:
  void find_corners();
  void find_edges();

  std::vector<Simplex> simplices_;
  std::vector<Exponents> exponents_;
  std::map<Exponents, std::int32_t> index_;
  std::vector<std::int32_t> corners_;
  std::vector<std::vector<Line>> edges_;
};

// The basis of products of polynomials of the two.
BernsteinBasis product_basis(const BernsteinBasis& a, const BernsteinBasis& b);

// The product of two terms adds to a term of the product, with a weight. The weights for one term add up to 1.
struct ProductTerm {
  std::int32_t a, b, product;
  double weight;
};
std::vector<ProductTerm> product_terms(const BernsteinBasis& a, const BernsteinBasis& b, const BernsteinBasis& product);

// Whether the polynomial is above `least` everywhere in the domain. Halves the domain along the edge where the
// coefficients bend most until they tell; `no` if it is not above somewhere, or nearly so after `most_halvings`.
inline constexpr int most_halvings = 500;
bool is_above(const BernsteinBasis& basis, std::span<const double> coefficients, double least);

}  // namespace hexpipe::curved
