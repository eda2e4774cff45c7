// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>
#include <pkg/solver/GrainProblem.hpp>
#include <vector>

namespace yade {

class ContactDynamicsPhys;

/// The contact laws that are Signorini-Coulomb after a change of variable (Jean 1999, 1.2, 2.1, 2.2). The solver sees shifted data only:
///
///     Newton restitution      s = e_N U_N(start)                        where the gap closes in this step and U_N(start) < -threshold
///     Moreau restitution      U_T shifted by e_T U_T(start)             likewise
///     static friction         mu of the step by the status of the last one
///     cohesion                r = R + h T n, h T n being an external impulse that pulls the bodies together, T the pull-off force
///     compliance              c = 1 / (h D),  s = (k g - k b h U(start)) / D,  D = k a h + d
///
/// Compliance: the spring sees g + a h U(end) - b h U(start), the gap averaged over neighbouring steps. a = b = 1/4 keeps the energy of an
/// oscillation and is second order; a = 1, b = 0 is the fully implicit rule, whose limit for k -> infinity is the rigid condition (24). They are
/// blended by p = x^2 / (1 + x^2), x = h^2 k W: a = (1 + 3 p) / 4, b = (1 - p) / 4. Rejected: a = 1 throughout loses a third of the amplitude
/// per period at 50 steps a period; a = b throughout lets stiff contacts chatter for ever.
class ShiftedContacts {
public:
	/// How the coming step meets one contact.
	struct Approach {
		Real gap;				   // [m]
		Vector3r relativeVelocity; // of body 2 to body 1 of the contact at the start of the step [m/s]
		bool forecast;			   // whether the gap closes in this step
		bool swapped;			   // the contact has the bodies of the interaction in reverse order
	};

	void clear(Real timeStep);
	/// Shifts the data of contact number `index`. In the order of the contacts, because the bodies' velocities change.
	void shift(contactdynamics::GrainProblem& problem, int index, ContactDynamicsPhys& phys, const Approach& approach);
	/// Back to true impulses and velocities, and what the law remembers (bond, stretch).
	/// @param tolerance  of the solve: a bond whose contact moves by no more than that of its strength holds
	void restore(contactdynamics::GrainProblem& problem, Real tolerance);

	/// The problem as it was solved: also from what restore() left.
	contactdynamics::GrainProblem asSolved(const contactdynamics::GrainProblem& problem) const;
	bool empty() const { return shifts.empty(); }

	/// Whether a contact of this law can carry a force without being pressed together in this step.
	static bool isBonded(const ContactDynamicsPhys& phys);
	/// Whether number `index` is an impact with restitution.
	bool isImpact(int index) const;

private:
	struct Shift {
		int index;
		ContactDynamicsPhys* phys;
		Vector3r tangential = Vector3r::Zero(); // added to the relative velocity [m/s]
		Real attraction = 0;					// h T [N s]
		bool bonded = false, impact = false, swapped = false;
	};

	void bond(const contactdynamics::Contact& contact, ContactDynamicsPhys& phys, Shift& made, const Approach& approach) const;
	void comply(contactdynamics::GrainProblem& problem, const ContactDynamicsPhys& phys, Shift& made, const Approach& approach) const;
	bool breaks(const contactdynamics::GrainProblem& problem, const Shift& made, const Vector3r& slip, Real tolerance) const;
	void stretch(const Shift& made, const contactdynamics::Contact& contact, const Vector3r& slip) const;

	Real h = 0;
	bool restored = false;
	std::vector<Shift> shifts; // by increasing index
};

} // namespace yade
