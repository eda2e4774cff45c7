// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>

namespace yade {

class ContactDynamicsPhys;
class EnergyTracker;

/// What the contacts of one step take from the kinetic energy, term by term. An impulse r does the work r.(U- + U+)/2 exactly, with U the relative
/// velocity at the start and the end of the step, so the sum of the terms closes the balance to round-off by construction; the split says why. As the
/// velocities of YADE's leapfrog belong to the middle of a step, so do the elastic energies: gap and stretch are taken half-way between two
/// positions.
class ContactEnergy {
public:
	/// @param start, end  relative velocity of the contact, [m/s];  @param gap  in the middle of the step [m]
	/// @param bonded      whether the contact was cohesive when the step began
	void add(const ContactDynamicsPhys& phys, const Vector3r& normal, const Vector3r& impulse, const Vector3r& start, const Vector3r& end, Real gap,
			 bool impact, bool bonded);
	/// Of the tangential spring, stretch and its rate as they are after the step.
	void addStretch(const ContactDynamicsPhys& phys, Real timeStep);
	/// @param torque  impulse on body 2 [N m s];  @param spin  mean relative angular velocity [rad/s]
	void addRolling(const Vector3r& torque, const Vector3r& spin) { rolling -= torque.dot(spin); }

	/// @param taken  what an impulse gives to a motion that is prescribed, so that it is lost to the free bodies [J]
	void addBoundary(Real taken) { boundary += taken; }

	/// Hands the terms to O.energy. `storedBefore` is the elastic energy after the step before; returns that of now [J].
	Real report(EnergyTracker& tracker, Real storedBefore) const;
	/// Repair displaces bodies against the external forces, and a cell against its stress: `work` of all of them, `known` of those whose work is in
	/// a term of O.energy that counts displacements by velocity only [J]: gravity in YADE's own `gravWork`, stress under control in `velGradWork`.
	static void reportRepair(EnergyTracker& tracker, Real work, Real known, const char* term = "gravWork");

private:
	Real friction = 0, rolling = 0, impact = 0, restitution = 0, cohesion = 0, compliant = 0, stored = 0, boundary = 0;
};

} // namespace yade
