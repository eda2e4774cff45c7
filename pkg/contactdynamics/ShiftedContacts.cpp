// SPDX-License-Identifier: GPL-2.0-or-later
#include "ShiftedContacts.hpp"
#include "ContactDynamicsPhys.hpp"
#include <pkg/solver/LocalDelassus.hpp>
#include <algorithm>

namespace yade {
namespace {
/// Bodies this much of a lever arm apart touch: round-off of positions, not physics.
constexpr Real touching = 1e-6;

/// The shorter lever arm [m]; that of a fixed body is zero, because its velocity is known, and does not count.
Real armLength(const contactdynamics::Contact& contact)
{
	const Real one = contact.arm1.norm(), two = contact.arm2.norm();
	return one > 0 && two > 0 ? std::min(one, two) : std::max(one, two);
}

/// Coefficients a, b of the class comment.
struct Averaging {
	Real end, start;
	explicit Averaging(Real hhkW)
	{
		const Real square = hhkW * hhkW, p = std::isfinite(square) ? square / (1 + square) : 1;
		end = (1 + 3 * p) / 4;
		start = (1 - p) / 4;
	}
};
Vector3r tangentialPart(const Vector3r& vector, const Vector3r& normal) { return vector - vector.dot(normal) * normal; }
} // namespace

void ShiftedContacts::clear(Real timeStep)
{
	h = timeStep;
	restored = false;
	shifts.clear();
}

bool ShiftedContacts::isBonded(const ContactDynamicsPhys& phys) { return phys.bond == "intact"; }

bool ShiftedContacts::isImpact(int index) const
{
	const auto found = std::lower_bound(shifts.begin(), shifts.end(), index, [](const Shift& s, int i) { return s.index < i; });
	return found != shifts.end() && found->index == index && found->impact;
}

void ShiftedContacts::bond(const contactdynamics::Contact& contact, ContactDynamicsPhys& phys, Shift& made, const Approach& approach) const
{
	if (!(phys.cohesionForce > 0 || phys.cohesionShear > 0)) return;
	if (phys.bond == "none" && (approach.gap <= touching * armLength(contact) || phys.status != "none")) phys.bond = "intact";
	made.bonded = isBonded(phys);
	if (made.bonded) made.attraction = h * (phys.cohesionForce + (phys.cohesionShear > 0 ? phys.cohesionShear / contact.friction : 0));
}

void ShiftedContacts::comply(contactdynamics::GrainProblem& problem, const ContactDynamicsPhys& phys, Shift& made, const Approach& approach) const
{
	contactdynamics::Contact& contact = problem.contacts[made.index];
	const Vector3r& n = contact.normal;
	const Matrix3r W =
			contactdynamics::localDelassus(problem.bodies[contact.body1], problem.bodies[contact.body2], contact, contactdynamics::contactFrame(n));
	if (phys.kn > 0) {
		const Averaging average(h * h * phys.kn * W(0, 0));
		const Real damping = approach.gap > 0 ? 0 : phys.normalDamping;
		const Real resistance = average.end * h * phys.kn + damping;
		contact.gapVelocity = phys.kn / resistance * (approach.gap - average.start * h * n.dot(approach.relativeVelocity));
		contact.normalCompliance = 1 / resistance / h;
	}
	if (phys.ks > 0) {
		const Averaging average(h * h * phys.ks * 0.5 * (W(1, 1) + W(2, 2)));
		const Real sign = made.swapped ? -1 : 1;
		const Vector3r stretch = sign * tangentialPart(phys.stretch, n), rate = sign * tangentialPart(phys.stretchRate, n);
		made.tangential = (stretch / h - average.start * rate) / average.end;
		contact.tangentialCompliance = 1 / (average.end * h * phys.ks) / h;
	}
}

void ShiftedContacts::shift(contactdynamics::GrainProblem& problem, int index, ContactDynamicsPhys& phys, const Approach& approach)
{
	contactdynamics::Contact& contact = problem.contacts[index];
	const Vector3r& n = contact.normal;
	Shift made;
	made.index = index;
	made.phys = &phys;
	made.swapped = approach.swapped;
	if (phys.status != "sliding") contact.friction = std::max(contact.friction, phys.staticFriction);
	bond(contact, phys, made, approach);

	const Real approachSpeed = -n.dot(approach.relativeVelocity);
	made.impact = !made.bonded && approach.forecast && approachSpeed > phys.restitutionVelocity &&
				  (phys.normalRestitution > 0 || phys.tangentialRestitution > 0);
	if (made.impact) {
		// An overlap that signorini pushes out faster than the bounce keeps its push.
		contact.gapVelocity = std::min(-phys.normalRestitution * approachSpeed, std::min(contact.gapVelocity, Real(0)));
		made.tangential = phys.tangentialRestitution * tangentialPart(approach.relativeVelocity, n);
	}
	if (phys.kn > 0 || phys.ks > 0) comply(problem, phys, made, approach);
	contact.imageVelocity += made.tangential;

	if (made.attraction > 0) {
		contact.gapVelocity -= contact.normalCompliance * made.attraction; // the mortar feels the true impulse
		const Vector3r pull = made.attraction * n;
		contact.impulse += pull;
		contactdynamics::Body &one = problem.bodies[contact.body1], &two = problem.bodies[contact.body2];
		one.velocity += one.inverseMass.cwiseProduct(pull);
		one.angularVelocity += one.inverseInertia * contact.arm1.cross(pull);
		two.velocity -= two.inverseMass.cwiseProduct(pull);
		two.angularVelocity -= two.inverseInertia * contact.arm2.cross(pull);
		if (problem.meanField) problem.meanField->gradient = problem.meanField->gradientWith(-pull * (contact.arm1 - contact.arm2).transpose());
	}
	shifts.push_back(made);
}

/// A bond breaks where its contact parts or slides. That it carries just its strength is not enough: of several contacts of the same two bodies some
/// may, while the others hold, because how they share the force is not unique.
bool ShiftedContacts::breaks(const contactdynamics::GrainProblem& problem, const Shift& made, const Vector3r& slip, Real tolerance) const
{
	const contactdynamics::Contact& contact = problem.contacts[made.index];
	const Vector3r& n = contact.normal;
	const Real mobility = n.dot((problem.bodies[contact.body1].inverseMass + problem.bodies[contact.body2].inverseMass).cwiseProduct(n));
	const Real still = tolerance * mobility * made.attraction; // what the bond would give way to a force beyond its strength by the tolerance [m/s]
	switch (contact.status) {
	case contactdynamics::ContactStatus::none:
		return n.dot(contact.relativeVelocity) + contact.gapVelocity > still;
	case contactdynamics::ContactStatus::sliding:
		return slip.norm() > still;
	default:
		return false;
	}
}

void ShiftedContacts::restore(contactdynamics::GrainProblem& problem, Real tolerance)
{
	restored = true;
	for (const Shift& made : shifts) {
		contactdynamics::Contact& contact = problem.contacts[made.index];
		const Vector3r slip = tangentialPart(contact.relativeVelocity + contact.tangentialCompliance * contact.impulse, contact.normal);
		contact.relativeVelocity -= made.tangential;
		contact.imageVelocity -= made.tangential;
		if (made.phys->ks > 0) stretch(made, contact, slip);
		if (!made.bonded) continue;
		if (breaks(problem, made, slip, tolerance)) made.phys->bond = "broken";
		contact.impulse -= made.attraction * contact.normal;
	}
}

contactdynamics::GrainProblem ShiftedContacts::asSolved(const contactdynamics::GrainProblem& problem) const
{
	contactdynamics::GrainProblem solved = problem;
	if (!restored) return solved; // the step ended with an error before
	for (const Shift& made : shifts) {
		contactdynamics::Contact& contact = solved.contacts[made.index];
		contact.relativeVelocity += made.tangential;
		contact.imageVelocity += made.tangential;
		contact.impulse += made.attraction * contact.normal;
	}
	return solved;
}

/// Where the contact sticks the spring takes the whole motion, where it slides all but the slip; an open contact forgets it.
void ShiftedContacts::stretch(const Shift& made, const contactdynamics::Contact& contact, const Vector3r& slip) const
{
	ContactDynamicsPhys& phys = *made.phys;
	if (contact.status == contactdynamics::ContactStatus::none) {
		phys.stretch = phys.stretchRate = Vector3r::Zero();
		return;
	}
	const Vector3r& n = contact.normal;
	const Real sign = made.swapped ? -1 : 1;
	Vector3r rate = tangentialPart(contact.relativeVelocity, n);
	if (contact.status == contactdynamics::ContactStatus::sliding) rate -= slip;
	phys.stretch = tangentialPart(phys.stretch, n) + sign * h * rate;
	phys.stretchRate = sign * rate;
}

} // namespace yade
