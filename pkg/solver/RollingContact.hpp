// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BallPack.hpp"
#include "GrainProblem.hpp"

namespace contactdynamics {

/// The torque of RollingFriction as the sweeps hold it, in global axes. Its visit follows that of the impulse, with the normal part found there:
///
///     M = P( M - w / W_w ),  P the projection on the disc l r_N across the normal and the interval m r_N along it
///
/// so within a sweep nothing lags. Rejected: torques and impulses in turn, each solved to the end while the other one is held. That converges for a
/// few balls, but in packings that move it goes on for ever: a torque that is held changes the normal impulses around, and with them all limits.
struct RollingContact {
	double rollingArm, twistingArm;		  // [m]
	Vector3 drive;						  // [rad/s]
	Matrix3 W;							  // mobility: relative angular velocity by torque impulse [1/(kg m2)]
	double inverseW;					  // of its largest eigenvalue, or a bound of that; 0 where nothing turns [kg m2]
	Vector3 torque, increment, direction; // as in BallPack [N m s]

	RollingContact() = default;
	RollingContact(const RollingFriction& friction, const Body& body1, const Body& body2);

	bool carries() const { return !torque.isZero(0) || !increment.isZero(0) || !direction.isZero(0); }
	void stop() { torque = increment = direction = Vector3::Zero(); }

	/// Brings a torque inside its limits.
	Vector3 inside(const Vector3& torque, const Vector3& normal, double normalImpulse) const;

	/// @param spin  angular velocity of body 2 minus that of body 1 [rad/s]
	Vector3 improved(const Vector3& torque, const Vector3& spin, const Vector3& normal, double normalImpulse) const
	{
		return inside(torque - inverseW * (spin + drive), normal, normalImpulse);
	}
};

} // namespace contactdynamics
