#pragma once
// The number of elements across a thin strip or wall.

namespace hexpipe::tetmesh::fields {

// One or two layers, by the width in sizes: whichever number stretches or compresses them less. Up to widest_to_decide
// both numbers are so near that some places might take one and some the other, if each decided for itself.
inline constexpr double widest_to_decide = 1.75;
inline int layers_across(double width) {
  constexpr double as_far_from_both = 1.41421356237309505;  // the square root of 1 times 2
  return width > as_far_from_both ? 2 : 1;
}

}  // namespace hexpipe::tetmesh::fields
