#pragma once
// How many elements go across what is thin.

namespace hexpipe::tetmesh::fields {

// Of what is so many sizes wide, one or two: whichever number stretches or presses them less. Up to
// widest_to_decide both are near enough for some places to take the one and some the other, if each is left to itself.
inline constexpr double widest_to_decide = 1.75;
inline int layers_across(double width) {
  constexpr double as_far_from_both = 1.41421356237309505;  // the square root of 1 times 2
  return width > as_far_from_both ? 2 : 1;
}

}  // namespace hexpipe::tetmesh::fields
