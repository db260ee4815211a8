#pragma once
// Three orthogonal axes without sign or order, as a function on the sphere with the symmetries of the cube.
//
// A frame is the function f(d) = sum over its axes of P4(d . axis), a spherical harmonic of degree 4, given by its nine
// coefficients (Huang, Tong, Wei, Bao 2011; Ray, Sokolov, Lévy 2016, "Practical 3D Frame Field Generation"). Frames
// that differ by a rotation of the cube have the same nine numbers, so frames can be averaged. nearest_frame() finds
// the frame again.

#include <Eigen/Core>
#include <array>

#include "common/mesh/vec3.hpp"

namespace hexpipe::tetmesh::fields {

// Coefficients of the real harmonics of degree 4, m = -4 .. 4, scaled so that those of a single direction have norm 1.
using Harmonics = Eigen::Matrix<double, 9, 1>;

// Orthonormal, right-handed or left-handed.
using Frame = std::array<Vec3, 3>;

// The coefficients of P4(d . axis). The scalar product with those of another axis is P4 of the cosine between the two.
Harmonics harmonics_of_axis(const Vec3& axis);

Harmonics harmonics_of(const Frame& frame);

// norm_squared(harmonics_of(frame)) for any frame.
inline constexpr double frame_norm_squared = 5.25;

// The coefficients of the cross of `first` and cross(normal, first): those of its frame less 7/4 of those of the
// normal, which all frames with this axis share. Their norm is cross_norm; turning `first` by 45 degrees changes their
// sign.
Harmonics harmonics_of_cross(const Vec3& normal, const Vec3& first);

inline constexpr double common_part = 1.75;
inline constexpr double cross_norm = 1.4790199457749041;  // sqrt(35) / 4

// The value of the function at a unit vector.
double value_at(const Harmonics& function, const Vec3& direction);

// The frame nearest to the function: the sum of the function over the axes is greatest. It climbs from `start`, so it
// finds a local maximum.
Frame climb_to_frame(const Harmonics& function, const Frame& start);

// The best frame that it reaches from several starts.
Frame nearest_frame(const Harmonics& function);

// The frame, turned by the least angle that lays the axis nearest to the direction on it.
Frame turned_onto(const Frame& frame, const Vec3& direction);

// An orthonormal frame whose first axis is the unit vector.
Frame frame_around(const Vec3& direction);

}  // namespace hexpipe::tetmesh::fields
