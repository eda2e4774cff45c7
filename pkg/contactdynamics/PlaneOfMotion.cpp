// SPDX-License-Identifier: GPL-2.0-or-later
#include "PlaneOfMotion.hpp"
#include <pkg/solver/LocalDelassus.hpp>
#include <cmath>

namespace yade {

using contactdynamics::Contact;
using contactdynamics::GrainProblem;

namespace {
/// Whether a velocity, or a mobility along the axes, stays in the plane.
bool inPlane(const contactdynamics::Body& body, int axis)
{
	const int b = (axis + 1) % 3, c = (axis + 2) % 3;
	if (body.velocity[axis] != 0 || body.angularVelocity[b] != 0 || body.angularVelocity[c] != 0 || body.inverseMass[axis] != 0) return false;
	for (int row = 0; row < 3; row++)
		for (int column = 0; column < 3; column++)
			if ((row != axis || column != axis) && body.inverseInertia(row, column) != 0) return false;
	return true;
}
bool inPlane(const Contact& contact, int axis)
{
	return contact.normal[axis] == 0 && contact.arm1[axis] == 0 && contact.arm2[axis] == 0 && contact.imageVelocity[axis] == 0 &&
		   contact.impulse[axis] == 0;
}
bool inPlane(const contactdynamics::RollingFriction& friction, int axis)
{
	const int b = (axis + 1) % 3, c = (axis + 2) % 3;
	return friction.drive[b] == 0 && friction.drive[c] == 0;
}
template <class Item> bool allInPlane(const std::vector<Item>& items, int axis)
{
	for (const Item& item : items)
		if (!inPlane(item, axis)) return false;
	return true;
}
} // namespace

int PlaneOfMotion::axisOf(const GrainProblem& problem)
{
	bool movable = false;
	for (const contactdynamics::Body& body : problem.bodies) movable = movable || body.inverseMass != contactdynamics::Vector3::Zero();
	if (!movable) return -1;
	for (int axis = 0; axis < 3; axis++)
		if (allInPlane(problem.bodies, axis) && allInPlane(problem.contacts, axis) && allInPlane(problem.rolling, axis)) return axis;
	return -1;
}

std::string PlaneOfMotion::nameOf(int axis)
{
	static const char* const names[] = {"yz", "zx", "xy"};
	return axis < 0 ? "" : names[axis];
}

bool PlaneOfMotion::completeAsBall(contactdynamics::Body& body, int axis)
{
	const double mobility = body.inverseMass[(axis + 1) % 3];
	if (mobility != body.inverseMass[(axis + 2) % 3]) return false;
	body.inverseMass[axis] = mobility;
	body.inverseInertia = body.inverseInertia(axis, axis) * contactdynamics::Matrix3::Identity();
	return true;
}

int ambiguousContacts(const GrainProblem& problem)
{
	int ambiguous = 0;
	const long count = static_cast<long>(problem.contacts.size());
#pragma omp parallel for schedule(static) reduction(+ : ambiguous) if (count > 500) // as parallelLoop
	for (long i = 0; i < count; i++) {
		const Contact& contact = problem.contacts[i];
		if (contact.ball || contact.friction == 0) continue;
		const auto frame = contactdynamics::contactFrame(contact.normal);
		const auto W = contactdynamics::localDelassus(problem.bodies[contact.body1], problem.bodies[contact.body2], contact, frame);
		if (W(0, 0) > 0 && !(contact.friction * std::hypot(W(0, 1), W(0, 2)) < W(0, 0))) ambiguous++;
	}
	return ambiguous;
}

} // namespace yade
