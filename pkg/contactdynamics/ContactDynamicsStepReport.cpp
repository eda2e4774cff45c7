// SPDX-License-Identifier: GPL-2.0-or-later
// What ContactDynamicsEngine shows of a step in Python.
#include "ContactDynamicsPhys.hpp"
#include "ContactDynamicsStep.hpp"
#include "ContactEnergy.hpp"
#include <boost/python/tuple.hpp>
#include <core/Scene.hpp>

namespace yade {

std::vector<ContactDynamicsStep::Twist> ContactDynamicsStep::free() const
{
	std::vector<Twist> twists;
	twists.reserve(motions.size());
	for (std::size_t i = 0; i < motions.size(); i++) twists.push_back(freeOf(static_cast<int>(i)));
	return twists;
}

std::vector<ContactDynamicsStep::Twist> ContactDynamicsStep::end() const
{
	std::vector<Twist> twists;
	twists.reserve(problem.bodies.size());
	for (const auto& body : problem.bodies) twists.push_back({body.velocity, body.angularVelocity});
	return twists;
}

boost::python::list ContactDynamicsStep::velocitiesById(const std::vector<Twist>& twists) const
{
	boost::python::list byId;
	for (const BodyView& view : views) {
		const bool own = view.state && !view.member && motions[view.index].moved;
		byId.append(own ? boost::python::object(boost::python::make_tuple(twists[view.index].velocity, twists[view.index].angularVelocity))
						: boost::python::object());
	}
	return byId;
}

boost::python::list ContactDynamicsStep::angularMomentaById() const
{
	std::vector<Vector3r> momenta;
	for (const FreeMotion& motion : motions) momenta.push_back(motion.angularMomentum);
	for (const auto& contact : problem.contacts) {
		momenta[contact.body1] -= contact.arm1.cross(contact.impulse);
		momenta[contact.body2] += contact.arm2.cross(contact.impulse);
	}
	for (const contactdynamics::RollingFriction& one : problem.rolling) {
		momenta[problem.contacts[one.contact].body1] -= one.torque;
		momenta[problem.contacts[one.contact].body2] += one.torque;
	}
	boost::python::list byId;
	for (const BodyView& view : views) {
		const bool own = view.state && !view.member && motions[view.index].aspherical;
		byId.append(own ? boost::python::object(momenta[view.index]) : boost::python::object());
	}
	return byId;
}

/// What a force on the body (and a torque about its mass centre) gives to the degrees of freedom that are blocked, whose velocity is prescribed [W].
Real ContactDynamicsStep::powerOnPrescribed(int index, const Vector3r& force, const Vector3r& torque) const
{
	const int held = motions[index].heldDOFs;
	const Twist start = atStart(index);
	const auto& end = problem.bodies[index];
	Real power = 0;
	for (int axis = 0; axis < 3; axis++) {
		if (held & State::axisDOF(axis, false)) power += 0.5 * force[axis] * (start.velocity[axis] + end.velocity[axis]);
		if (held & State::axisDOF(axis, true)) power += 0.5 * torque[axis] * (start.angularVelocity[axis] + end.angularVelocity[axis]);
	}
	return power;
}

void ContactDynamicsStep::trackEnergy(Scene& scene)
{
	ContactEnergy energy;
	for (std::size_t i = 0; i < links.size(); i++) {
		const contactdynamics::Contact& contact = problem.contacts[i];
		if (contact.impulse == Vector3r::Zero() && !(links[i].phys->kn > 0 || links[i].phys->ks > 0)) continue;
		const Vector3r start = velocityAtStart(contact);
		energy.add(*links[i].phys, contact.normal, contact.impulse, start, contact.relativeVelocity,
				   links[i].gap + 0.5 * h * contact.normal.dot(contact.relativeVelocity), shifted.isImpact(static_cast<int>(i)), bonded[i]);
		energy.addStretch(*links[i].phys, h);
		const Link& link = links[i];
		const BodyView &view1 = views[link.id1], &view2 = views[link.id2];
		const Vector3r belt = beltVelocity(view2, link.arm2, contact.normal) - beltVelocity(view1, link.arm1, contact.normal);
		energy.addBoundary((link.swapped ? -1 : 1) * contact.impulse.dot(belt));
	}
	for (const contactdynamics::RollingFriction& friction : problem.rolling) {
		const int one = problem.contacts[friction.contact].body1, two = problem.contacts[friction.contact].body2;
		const auto spin = [&](int index) { return Vector3r(0.5 * (atStart(index).angularVelocity + problem.bodies[index].angularVelocity)); };
		energy.addRolling(friction.torque, spin(two) - spin(one) + friction.drive);
		energy.addBoundary(friction.torque.dot(friction.drive));
	}
	for (std::size_t id = 0; id < loads.size(); id++) { // loads refer to the positions of the bodies, those of clump members to their own
		const BodyView& view = views[id];
		if (!view.state) continue;
		const Vector3r toCentre = view.state->pos - views[idOfIndex[view.index]].state->pos;
		energy.addBoundary(h * powerOnPrescribed(view.index, loads[id].force, loads[id].torque + toCentre.cross(loads[id].force)));
	}
	elasticEnergy = energy.report(*scene.energy, elasticEnergy);
}

} // namespace yade
