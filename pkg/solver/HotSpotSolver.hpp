// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainOperator.hpp"
#include "HotSpot.hpp"

namespace contactdynamics {

/// Settles what sweeps over all contacts cannot: a nonlinear Schwarz method, whose subdomains are the surroundings of the largest changes.
class HotSpotSolver {
public:
	struct Terms {
		double tolerance;			///< of the collection [-]
		int sweepsLeft, sweepsDone; ///< over all contacts: what a spot may cost, and what bounds its Newton steps
	};
	struct Outcome {
		bool settled = false;  ///< the operator has new impulses
		double sweeps = 0;	   ///< over all contacts that would have visited as many
		int newtonSteps = 0;   ///< they alone allocate memory
		double newtonCost = 0; ///< in such sweeps
	};

	/// Before a solve.
	void start();
	/// Solves the contacts around the largest changes of the last sweep, all others held, and puts their impulses in place.
	Outcome settle(GrainOperator& op, const Terms& terms, Crew& crew);

private:
	HotSpot spot;
	GrainProblem part;
	GrainOperator operatorOfPart;
	std::vector<Matrix3> frames;
	double newtonSpent = 0; // in this solve, in sweeps

	bool solve(double tolerance, const Terms& terms, Crew& crew, Outcome& outcome);
	bool solveByNewton(double tolerance, const Terms& terms, Outcome& outcome);
};

} // namespace contactdynamics
