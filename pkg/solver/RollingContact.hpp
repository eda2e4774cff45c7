// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainProblem.hpp"

namespace contactdynamics {

struct RollingPack;

/// The torque of RollingFriction as the sweeps hold it, in global axes. Its visit follows that of the impulse, with the normal part found there:
///
///     M = P( M - w / W_w ),  P the projection on the disc l r_N across the normal and the interval m r_N along it
///
/// so within a sweep nothing lags. Rejected: torques and impulses in turn, each solved to the end while the other one is held. That converges for a
/// few balls, but mostly not in packings that move: a torque that is held changes the normal impulses around, and with them all limits.
///
/// W_w is a number, the largest angular velocity by a unit of torque; for balls it is that in all directions. Where nothing turns (driven rollers on
/// a plate) it is taken as W_NN / l^2 in the residual, and as next to nothing in the visit: the torque goes to its limit at once.
struct RollingContact {
	double rollingArm, twistingArm;		  // [m]
	Vector3 drive;						  // [rad/s]
	double mobility, inverseMobility;	  // W_w of the residual, and 1 / W_w of the visit; 0 where no impulse moves the bodies [1/(kg m2)], [kg m2]
	Vector3 torque, increment, direction; // as in BallPack [N m s]

	RollingContact() = default;
	RollingContact(const RollingFriction& friction, const GrainProblem& problem);

	void put(RollingPack& pack, int lane) const;
	void take(const RollingPack& pack, int lane);

	bool carries() const { return !torque.isZero(0) || !increment.isZero(0) || !direction.isZero(0); }
	void stop() { torque = increment = direction = Vector3::Zero(); }

	/// Brings a torque inside its limits.
	Vector3 inside(const Vector3& torque, const Vector3& normal, double normalImpulse) const;

	/// @param spin  angular velocity of body 2 minus that of body 1 [rad/s]
	Vector3 improved(const Vector3& torque, const Vector3& spin, const Vector3& normal, double normalImpulse) const
	{
		return inside(torque - inverseMobility * (spin + drive), normal, normalImpulse);
	}
};

} // namespace contactdynamics
