// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>
#include <pkg/solver/SignoriniCoulombSolver.hpp>
#include <vector>

namespace yade {

/// Removes overlaps by moving bodies, not by pushing them: the displacements d = M^-1 H p of frictionless pseudo-impulses p with
///
///     0 <= d_N + s _|_ p_N + c >= 0,   s = g+          where g+ = gap at the end of the step + allowed overlap is >= 0: the room that is left,
///                                      s = share g+    where it is < 0: all overlaps shrink by the same share in a step.
///
/// Nothing of it enters a velocity, so that no overlap, however large, becomes kinetic energy; with the true masses, a free cluster keeps its mass
/// centre. A push through the velocity, as `signorini` (24) makes it, was rejected for the repair because of that energy. Bodies are moved without
/// being turned: a turn would change the lever arms and the inertia tensor for which the contact problem has just been solved, and a translation
/// parts any two bodies.
///
/// c > 0 at contacts that carry an impulse (0 elsewhere) lets them pull, so that they stay closed while their neighbours move: without it, contacts
/// of a packing open, lose their reaction, and the grains they held fall. The solver knows no c; it gets p + c as unknown and the bodies displaced by
/// -M^-1 H c.
class PenetrationRepair {
public:
	/// What the repair needs to know of a contact beside the solved problem.
	struct Overlap {
		Real gap;	 // at the start of the step [m]
		Real radius; // of the smaller sphere, the measure of what is small [m]; 0: leave this contact alone
	};

	/// @param solved    the contact problem after the solve: mobilities, normals, and the velocities that are about to move the bodies by h U
	/// @param overlaps  parallel to solved.contacts
	/// @param rate      largest share of the overlap beyond the allowed one that is taken away [-], 0 … 1; 0 only measures
	/// @param allowed   overlap that is left alone, in radii [-], >= 0
	/// @return          whether any body is to be moved
	bool solve(const contactdynamics::GrainProblem& solved, const std::vector<Overlap>& overlaps, Real h, Real rate, Real allowed, int threads);

	Vector3r displacement(int body) const { return problem.bodies[body].velocity; } // by solver index [m]; after solve() has returned true
	Real remainingOverlap() const { return remaining; }								// largest at the end of the step, repair included [m]
	Real largestDisplacement() const { return largest; }							// [m]

private:
	contactdynamics::GrainProblem problem; // displacements [m] in the place of velocities
	std::vector<Real> gapAtEnd;			   // without repair [m]
	contactdynamics::SignoriniCoulombSolver solver;
	Real remaining = 0, largest = 0;
	Real smallestRadius = 0, deepest = 0; // deepest overlap in radii

	bool measure(const contactdynamics::GrainProblem& solved, const std::vector<Overlap>& overlaps, Real h, Real allowed);
	void letPull(contactdynamics::Contact& contact, Real displacement);
	void limit(Real allowedDisplacement);
};

} // namespace yade
