// SPDX-License-Identifier: GPL-2.0-or-later
// A periodic cell that moves with the contacts: the solver sees velocities relative to the mean field, and the gradient of the field as one more
// body.
#include "ContactDynamicsStep.hpp"
#include <core/State.hpp>
#include <stdexcept>

namespace yade {

void ContactDynamicsStep::useMeanField(const contactdynamics::MeanField& field, const IntegratorPlan& plan)
{
	planOfField.emplace(plan);
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
	planOfField->useVelGrad(velGrad);
	displacementAsVelocity = planOfField->velocityOfDisplacement();
	for (std::size_t i = 0; i < places.size(); i++) problem.bodies[i].velocity += velGrad * places[i];
}

/// How far the image of body 2 that a contact touches stands from body 2 itself.
Vector3r ContactDynamicsStep::shiftOf(const contactdynamics::Contact& contact) const
{
	return contact.arm1 - contact.arm2 - places[contact.body2] + places[contact.body1];
}

/// Relative velocity before impulses and external forces act in this step. Where there is a mean field, with the gradient of before and moved along
/// with the field: then work and energy of a step balance exactly.
Vector3r ContactDynamicsStep::velocityAtStart(const contactdynamics::Contact& contact) const
{
	if (!problem.meanField) return relativeVelocity(contact, atStart(contact.body1), atStart(contact.body2));
	const Matrix3r& before = planOfField->prevVelGrad;
	const auto carried = [&](int index) {
		Twist twist = atStart(index);
		if (planOfField->homoDeform > 1) twist.velocity += h * before * twist.velocity;
		return twist;
	};
	return relativeVelocity(contact, carried(contact.body1), carried(contact.body2)) + (before - velGrad) * shiftOf(contact);
}

Matrix3r ContactDynamicsStep::moment() const
{
	Matrix3r sum = Matrix3r::Zero();
	for (const auto& contact : problem.contacts)
		if (contact.impulse != Vector3r::Zero()) sum += contact.impulse * (contact.arm1 - contact.arm2).transpose();
	return sum;
}

} // namespace yade
