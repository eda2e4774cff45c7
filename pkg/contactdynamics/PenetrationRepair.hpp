// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>
#include <pkg/solver/SignoriniCoulombSolver.hpp>
#include <vector>

namespace yade {

/// Removes overlaps by moving bodies, not by pushing them: the displacements d = M^-1 H p of pseudo-impulses p that satisfy the frictionless
/// Signorini problem
///
///     0 <= d_N + s _|_ p_N >= 0,   s = g+                             where g+ = gap at the end of the step + allowed overlap is >= 0 (the room that
///     is left),
///                                  s = max(rate g+, -r/10000)         where it is < 0 (the share of the overlap that is taken away in this step).
///
/// Nothing of it enters a velocity, so that no overlap, however large, becomes kinetic energy; with the true masses, a free cluster keeps its mass
/// centre. A push through the velocity, as `signorini` (24) makes it, was rejected for the repair because of that energy. Bodies are moved without
/// being turned: a turn would change the lever arms and the inertia tensor for which the contact problem has just been solved, and a translation
/// parts any two bodies.
class PenetrationRepair {
public:
	/// What the repair needs to know of a contact beside the solved problem.
	struct Overlap {
		Real gap;	 // at the start of the step [m]
		Real radius; // of the smaller sphere, the measure of what is small [m]; 0: leave this contact alone
	};

	/// @param solved    the contact problem after the solve: mobilities, normals, and the velocities that are about to move the bodies by h U
	/// @param overlaps  parallel to solved.contacts
	/// @param rate      share of the overlap beyond the allowed one that is taken away [-], 0 … 1; 0 only measures
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

	void limit(Real allowedDisplacement);
};

} // namespace yade
