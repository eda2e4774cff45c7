// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace contactdynamics {

enum class SolveStatus {
	converged,	   ///< residual <= tolerance at the returned point
	maxIterations, ///< residual > tolerance; the point, the best one kept (plain sweeps: the last), is in the cones and goes with the velocities
	notFinite,	   ///< input or iterate not finite: bodies and impulses are left as given
	unbounded	   ///< the tolerance is met, but by impulses that grow without bound while contacts go on closing, see Squeeze.hpp
};

struct SolveReport {
	SolveStatus status = SolveStatus::converged;
	int iterations = 0;			 ///< sweeps done; grains: those over hot spots by their share of the contacts
	int newtonSteps = 0;		 ///< linear systems solved: by Newton finish and central path; grains: in hot spots (HotSpotSolver.hpp)
	double residual = 0;		 ///< relative natural map at the returned point, over all contacts, see NaturalMap.hpp [-]
	double maxApproachSpeed = 0; ///< largest max(0, -(U_N + s)) at the returned point [m/s]
	int activeContacts = 0;		 ///< contacts with a non-zero impulse
	int ambiguousContacts = 0;	 ///< 2D blocks only: contacts that violate (33) of Jean (1999), |mu W_TN| < W_NN (Painleve)
};

} // namespace contactdynamics
