// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>

namespace yade {

class Body;

/// @param force, torque        total external force and torque on the body [N], [N m]
/// @throws std::runtime_error  when position, orientation, a velocity, force or torque is not finite, or mass or inertia is not finite
///                             and positive along a free degree of freedom. Names body, attribute, value and what is allowed.
void requireUsableState(const Body& body, const Vector3r& force, const Vector3r& torque);
/// @throws std::runtime_error  when the factor by which density scaling multiplies the body's accelerations is not positive and finite
void requirePositiveScaling(const Body& body, Real scaling);
/// @throws std::runtime_error  when the radius of the body's sphere is not positive and finite [m]
void requirePositiveRadius(const Body& body, Real radius);
/// @throws std::runtime_error  when the velocity gradient of the periodic cell is not finite [1/s]
void requireFiniteGradient(const Matrix3r& velGrad);

} // namespace yade
