// SPDX-License-Identifier: GPL-2.0-or-later
#include "RollingContact.hpp"

#include <algorithm>
#include <cmath>

namespace contactdynamics {

RollingContact::RollingContact(const RollingFriction& friction, const Body& body1, const Body& body2)
	: rollingArm(friction.rollingArm), twistingArm(friction.twistingArm), drive(friction.drive), W(body1.inverseInertia + body2.inverseInertia),
	  torque(friction.torque), increment(Vector3::Zero()), direction(Vector3::Zero())
{
	const double largest = W.cwiseAbs().rowwise().sum().maxCoeff(); // at least the largest eigenvalue; equal to it for balls
	inverseW = largest > 0 ? 1 / largest : 0;
}

Vector3 RollingContact::inside(const Vector3& given, const Vector3& normal, double normalImpulse) const
{
	if (!(normalImpulse > 0)) return normalImpulse <= 0 ? Vector3(Vector3::Zero()) : given; // not finite stays visible
	const double along = given.dot(normal), most = twistingArm * normalImpulse, limit = rollingArm * normalImpulse;
	const Vector3 across = given - along * normal;
	const double length = across.norm();
	return std::min(std::max(along, -most), most) * normal + (length > limit ? limit / length : 1) * across;
}

} // namespace contactdynamics
