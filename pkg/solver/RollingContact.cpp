// SPDX-License-Identifier: GPL-2.0-or-later
#include "RollingContact.hpp"

#include "BallPack.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace contactdynamics {

RollingContact::RollingContact(const RollingFriction& friction, const GrainProblem& problem)
	: rollingArm(friction.rollingArm), twistingArm(friction.twistingArm), drive(friction.drive), mobility(0), inverseMobility(0),
	  torque(friction.torque), increment(Vector3::Zero()), direction(Vector3::Zero())
{
	const Contact& c = problem.contacts[friction.contact];
	const Body &one = problem.bodies[c.body1], &two = problem.bodies[c.body2];
	const Matrix3 W = one.inverseInertia + two.inverseInertia;
	mobility = W.cwiseAbs().rowwise().sum().maxCoeff(); // at least the largest eigenvalue; equal to it for balls
	const double arm = std::max(rollingArm, twistingArm);
	double overstep = 1;
	if (mobility == 0 && arm > 0) {
		mobility = (one.inverseMass + two.inverseMass).dot(c.normal.cwiseAbs2()) / (arm * arm);
		overstep = 1e6; // nothing moves in return: at the limit in one visit, with ten digits of the direction left
	}
	if (mobility > 0) inverseMobility = overstep / mobility;
}

void RollingContact::put(RollingPack& pack, int lane) const
{
	pack.rollingArm[lane] = rollingArm;
	pack.twistingArm[lane] = twistingArm;
	pack.mobility[lane] = mobility;
	pack.inverseMobility[lane] = inverseMobility;
	for (int k = 0; k < 3; ++k) {
		pack.drive[k][lane] = drive[k];
		pack.torque[k][lane] = torque[k];
		pack.increment[k][lane] = increment[k];
		pack.direction[k][lane] = direction[k];
	}
}

void RollingContact::take(const RollingPack& pack, int lane)
{
	for (int k = 0; k < 3; ++k) {
		torque[k] = pack.torque[k][lane];
		increment[k] = pack.increment[k][lane];
		direction[k] = pack.direction[k][lane];
	}
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
