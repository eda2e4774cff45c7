// SPDX-License-Identifier: GPL-2.0-or-later
// Two-dimensional scenes: disks enter the solve as the balls they are within their plane.
#include "ContactDynamicsStep.hpp"
#include "PlaneOfMotion.hpp"

namespace yade {
namespace {
/// A mean field acts on the vector between the centres, which the closed form takes to be along the normal.
bool alongNormal(const contactdynamics::Contact& contact)
{
	const Vector3r branch = contact.arm1 - contact.arm2;
	return branch.cross(contact.normal).norm() <= 1e-14 * branch.norm();
}
} // namespace

void ContactDynamicsStep::usePlane()
{
	planeAxis = PlaneOfMotion::axisOf(problem);
	if (planeAxis < 0) return;
	std::vector<std::uint8_t> disk(problem.bodies.size(), false); // or immobile, which is as good
	for (const BodyView& view : views) {
		if (!view.state || view.member) continue;
		disk[view.index] = view.fixed || (view.radius > 0 && PlaneOfMotion::completeAsBall(problem.bodies[view.index], planeAxis));
	}
	for (contactdynamics::Contact& contact : problem.contacts)
		contact.ball = disk[contact.body1] && disk[contact.body2] && (contact.ball || !problem.meanField || alongNormal(contact));
	// What is left of a belt that once turned out of the plane.
	for (contactdynamics::RollingFriction& friction : problem.rolling) friction.torque = friction.torque[planeAxis] * Vector3r::Unit(planeAxis);
}

} // namespace yade
