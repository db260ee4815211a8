#pragma once
// Three orthogonal axes without sign or order, as a function on the sphere: what they have in common with the cube.
//
// A frame is the function f(d) = sum over its axes of P4(d . axis), a spherical harmonic of degree 4, given by its nine
// coefficients (Huang, Tong, Wei, Bao 2011; Ray, Sokolov, Lévy 2016, "Practical 3D Frame Field Generation"). Frames
// that differ by a rotation of the cube are the same nine numbers, so that they can be averaged; nearest_frame() comes
// back.

#include <Eigen/Core>
#include <array>

#include "common/mesh/vec3.hpp"

namespace hexpipe::tetmesh::fields {

// Coefficients of the real harmonics of degree 4, m = -4 .. 4, scaled so that those of a single direction have norm 1.
using Harmonics = Eigen::Matrix<double, 9, 1>;

// Orthonormal, right-handed or left-handed.
using Frame = std::array<Vec3, 3>;

// Of the function P4(d . axis); its scalar product with that of another direction is P4 of their cosine.
Harmonics harmonics_of_axis(const Vec3& axis);

Harmonics harmonics_of(const Frame& frame);

// norm_squared(harmonics_of(frame)) for any frame.
inline constexpr double frame_norm_squared = 5.25;

// Of the cross of `first` and cross(normal, first): what its frame has beside 7/4 of the normal's function, which all
// frames with this axis share. Of norm cross_norm; turning `first` by 45 degrees changes its sign.
Harmonics harmonics_of_cross(const Vec3& normal, const Vec3& first);

inline constexpr double common_part = 1.75;
inline constexpr double cross_norm = 1.4790199457749041;  // sqrt(35) / 4

// The value of the function at a unit vector.
double value_at(const Harmonics& function, const Vec3& direction);

// A frame for which the function, summed over the axes, is greatest: the frame nearest to the function. Climbs from
// `start`, so that it finds a local maximum.
Frame climb_to_frame(const Harmonics& function, const Frame& start);

// The best that is reached from several starts.
Frame nearest_frame(const Harmonics& function);

// The frame turned by the least angle that lays one of its axes, that is nearest already, on the direction.
Frame turned_onto(const Frame& frame, const Vec3& direction);

// An orthonormal frame whose first axis is the unit vector.
Frame frame_around(const Vec3& direction);

}  // namespace hexpipe::tetmesh::fields
