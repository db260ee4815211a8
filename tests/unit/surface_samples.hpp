#pragma once
// Closed surfaces to test with: boxes of any subdivision, and spheres.

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "formats/surfaces/surface_building.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::testing {
using namespace formats;

using Facet = std::array<Vec3, 3>;
using Facets = std::vector<Facet>;

// A box, outward, each side cut into n x n rectangles of two triangles.
inline Facets box(const Vec3& low, const Vec3& high, int n = 1) {
  Facets facets;
  const Vec3 extent = high - low;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      auto corner = [&](int i, int j) {
        double unit[3];
        unit[axis] = side;
        unit[(axis + 1) % 3] = static_cast<double>(i) / n;
        unit[(axis + 2) % 3] = static_cast<double>(j) / n;
        return low + Vec3{unit[0] * extent.x, unit[1] * extent.y, unit[2] * extent.z};
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const Vec3 a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
          if (side == 1)
            facets.insert(facets.end(), {Facet{a, b, c}, Facet{a, c, d}});
          else
            facets.insert(facets.end(), {Facet{a, c, b}, Facet{a, d, c}});
        }
      }
    }
  }
  return facets;
}

inline Facets cube(double low = 0, double size = 1, int n = 1) {
  return box({low, low, low}, {low + size, low + size, low + size}, n);
}

// Corner i of n, around the z axis.
inline Vec3 rim_point(int n, int i, double radius, double z) {
  const double angle = 2 * std::numbers::pi * (i % n) / n;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

// A prism of n sides, outward, closed by two fans of slivers.
inline Facets prism(int n, double radius, double length) {
  Facets facets;
  auto rim = [&](int i, double z) { return rim_point(n, i, radius, z); };
  for (int i = 0; i < n; ++i) {
    const Vec3 a = rim(i, 0), b = rim(i + 1, 0), c = rim(i + 1, length), d = rim(i, length);
    facets.insert(facets.end(),
                  {Facet{a, b, c}, Facet{a, c, d}, Facet{Vec3{0, 0, 0}, b, a}, Facet{Vec3{0, 0, length}, d, c}});
  }
  return facets;
}

// A prism of n sides with a hole of n sides in its middle, outward.
inline Facets ring(int n, double inner_radius, double outer_radius, double length) {
  Facets facets;
  for (int i = 0; i < n; ++i) {
    std::array<Vec3, 4> here, next;  // once around the cross section
    for (std::size_t k = 0; k < 4; ++k) {
      const double radius = k == 0 || k == 3 ? inner_radius : outer_radius, z = k < 2 ? 0 : length;
      here[k] = rim_point(n, i, radius, z);
      next[k] = rim_point(n, i + 1, radius, z);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t l = (k + 1) % 4;
      facets.insert(facets.end(), {Facet{here[k], next[l], here[l]}, Facet{here[k], next[k], next[l]}});
    }
  }
  return facets;
}

// A sphere of `n` bands of latitude and 2 n of longitude, outward.
inline Facets sphere(const Vec3& centre, double radius, int n) {
  Facets facets;
  auto point = [&](int i, int j) {
    if (i == 0 || i == n) return centre + Vec3{0, 0, i == 0 ? radius : -radius};
    const double latitude = std::numbers::pi * i / n, longitude = std::numbers::pi * (j % (2 * n)) / n;
    return centre + radius * Vec3{std::sin(latitude) * std::cos(longitude), std::sin(latitude) * std::sin(longitude),
                                  std::cos(latitude)};
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < 2 * n; ++j) {
      if (i > 0) facets.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
      if (i + 1 < n) facets.push_back({point(i, j + 1), point(i + 1, j), point(i + 1, j + 1)});
    }
  }
  return facets;
}

inline Facets inverted(Facets facets) {
  for (Facet& facet : facets) std::swap(facet[1], facet[2]);
  return facets;
}

inline Facets joined(Facets a, const Facets& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// As a reader of binary STL would leave them, called "part".
inline SurfaceSoup soup_of(const Facets& facets) {
  SurfaceSoup soup;
  soup.text = false;
  soup.name = "part";
  PointMerger merger(soup.points);
  for (const Facet& facet : facets) {
    soup.triangles.push_back({merger.index_of(facet[0]), merger.index_of(facet[1]), merger.index_of(facet[2])});
    soup.tags.push_back(0);
    soup.places.push_back(static_cast<std::int64_t>(soup.triangles.size()));
  }
  return soup;
}

}  // namespace hexpipe::testing
