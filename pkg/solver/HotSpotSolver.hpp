// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainOperator.hpp"
#include "HotSpot.hpp"
#include "JoinedGroups.hpp"

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
	struct Group { // contacts that are linked by bodies
		std::int32_t number = -1;
		void add(const Group&) {}
	};

	HotSpot spot;
	JoinedGroups<Group> groups;
	std::vector<std::vector<std::int32_t>> members; // of each group
	std::vector<std::int32_t> bodyOf;				// of the spot in the part; -1 for all between two parts
	GrainProblem part;
	std::vector<std::int32_t> bodiesOfPart; // in the spot
	GrainOperator operatorOfPart;
	std::vector<Matrix3> frames;
	int parts = 0;
	double newtonSpent = 0; // in this solve, in sweeps

	void divide();
	void take(const std::vector<std::int32_t>& contacts);
	bool solve(double tolerance, const Terms& terms, Crew& crew, Outcome& outcome);
	bool solveByNewton(double tolerance, const Terms& terms, Outcome& outcome);
};

} // namespace contactdynamics
