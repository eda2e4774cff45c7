// SPDX-License-Identifier: GPL-2.0-or-later
// What ContactDynamicsEngine shows of a step in Python.
#include "ContactDynamicsStep.hpp"
#include <boost/python/tuple.hpp>

namespace yade {

std::vector<ContactDynamicsStep::Twist> ContactDynamicsStep::end() const
{
	std::vector<Twist> twists;
	twists.reserve(problem.bodies.size());
	for (const auto& body : problem.bodies)
		twists.push_back({ body.velocity, body.angularVelocity });
	return twists;
}

boost::python::list ContactDynamicsStep::velocitiesById(const std::vector<Twist>& twists) const
{
	boost::python::list byId;
	for (const BodyView& view : views) {
		const bool own = view.state && !view.member && motions[view.index].moved;
		byId.append(own ? boost::python::object(boost::python::make_tuple(twists[view.index].velocity, twists[view.index].angularVelocity)) : boost::python::object());
	}
	return byId;
}

boost::python::list ContactDynamicsStep::angularMomentaById() const
{
	std::vector<Vector3r> momenta;
	for (const FreeMotion& motion : motions)
		momenta.push_back(motion.angularMomentum);
	for (const auto& contact : problem.contacts) {
		momenta[contact.body1] -= contact.arm1.cross(contact.impulse);
		momenta[contact.body2] += contact.arm2.cross(contact.impulse);
	}
	boost::python::list byId;
	for (const BodyView& view : views) {
		const bool own = view.state && !view.member && motions[view.index].aspherical;
		byId.append(own ? boost::python::object(momenta[view.index]) : boost::python::object());
	}
	return byId;
}

} // namespace yade
