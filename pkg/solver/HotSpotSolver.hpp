// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"
#include "GrainOperator.hpp"
#include "HotSpot.hpp"
#include "JoinedGroups.hpp"

namespace contactdynamics {

/// Settles what sweeps over all contacts cannot: a nonlinear Schwarz method, whose subdomains are the surroundings of the largest changes.
class HotSpotSolver {
public:
	struct Outcome {
		bool settled = false; ///< the operator has new impulses
		double sweeps = 0;	  ///< over all contacts that would have visited as many
		int newtonSteps = 0;
		double newtonCost = 0; ///< in such sweeps
	};

	void start() { spot.room = HotSpot::mostContacts; } ///< before a solve
	/// Solves the contacts around the largest changes of the last sweep, all others held, and puts their impulses in place.
	Outcome settle(GrainOperator& op, double tolerance, Crew& crew);

private:
	struct Group { // contacts that are linked by bodies
		std::int32_t number = -1;
		void add(const Group&) {}
	};

	HotSpot spot;
	JoinedGroups<Group> groups;
	std::vector<std::vector<std::int32_t>> members; // of each group
	std::vector<std::int32_t> bodyOf;				// of the spot in the part, -1: none
	GrainProblem part;
	GrainOperator sweeps;
	std::vector<Matrix3> frames;
	int parts = 0;

	void divide();
	void take(const std::vector<std::int32_t>& contacts);
	bool sweep(double tolerance, Crew& crew, Outcome& outcome);
	bool solveByNewton(double tolerance, Outcome& outcome);
};

} // namespace contactdynamics
