// SPDX-License-Identifier: GPL-2.0-or-later
// A periodic cell that moves with the contacts: the solver sees velocities relative to the mean field, and the gradient of the field as one more
// body.
#include "ContactDynamicsStep.hpp"
#include <core/State.hpp>
#include <stdexcept>

namespace yade {

void ContactDynamicsStep::useMeanField(const contactdynamics::MeanField& field)
{
	problem.meanField = field;
	places.resize(idOfIndex.size());
	for (std::size_t index = 0; index < places.size(); index++) {
		const int id = idOfIndex[index];
		if (!motions[index].moved)
			throw std::runtime_error("body #" + std::to_string(id) +
									 " is left out by NewtonIntegrator.mask, but a ContactDynamicsCellController moves all "
									 "bodies with the cell; it needs NewtonIntegrator(mask=0).");
		places[index] = views[id].state->pos;
	}
}

void ContactDynamicsStep::toMeanField()
{
	for (std::size_t i = 0; i < places.size(); i++) problem.bodies[i].velocity -= velGrad * places[i];
}

void ContactDynamicsStep::fromMeanField()
{
	velGrad = problem.meanField->gradient;
	for (std::size_t i = 0; i < places.size(); i++) problem.bodies[i].velocity += velGrad * places[i];
}

Matrix3r ContactDynamicsStep::moment() const
{
	Matrix3r sum = Matrix3r::Zero();
	for (const auto& contact : problem.contacts)
		if (contact.impulse != Vector3r::Zero()) sum += contact.impulse * (contact.arm1 - contact.arm2).transpose();
	return sum;
}

} // namespace yade
