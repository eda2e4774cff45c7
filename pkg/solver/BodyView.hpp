// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BallPack.hpp"
#include "GrainProblem.hpp"

#include <Eigen/Geometry>

namespace contactdynamics {

/// The plain arrays of a BodyState as vectors.
inline Eigen::Map<const Eigen::Vector3d> velocity(const BodyState& body) { return Eigen::Map<const Eigen::Vector3d>(body.velocity); }
inline Eigen::Map<const Eigen::Vector3d> angularVelocity(const BodyState& body) { return Eigen::Map<const Eigen::Vector3d>(body.angularVelocity); }
inline Eigen::Map<Eigen::Vector3d> velocity(BodyState& body) { return Eigen::Map<Eigen::Vector3d>(body.velocity); }
inline Eigen::Map<Eigen::Vector3d> angularVelocity(BodyState& body) { return Eigen::Map<Eigen::Vector3d>(body.angularVelocity); }

/// Adds to the velocities what an impulse with this arm does to the body.
template <class Linear, class Angular>
void applyImpulse(Linear&& velocity, Angular&& angularVelocity, const Body& body, const Vector3& arm, const Vector3& impulse)
{
	velocity += body.inverseMass.cwiseProduct(impulse);
	angularVelocity += body.inverseInertia * arm.cross(impulse);
}

} // namespace contactdynamics
