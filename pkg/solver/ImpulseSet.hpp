// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainProblem.hpp"

namespace contactdynamics {

/// Impulses at the contacts of a problem, and torques parallel to GrainProblem::rolling, global axes [N s], [N m s].
struct ImpulseSet {
	std::vector<Vector3> impulses, torques;

	void take(const GrainProblem& from)
	{
		impulses.clear();
		torques.clear();
		for (const Contact& c : from.contacts) impulses.push_back(c.impulse);
		for (const RollingFriction& one : from.rolling) torques.push_back(one.torque);
	}
	void subtract(const GrainProblem& others)
	{
		for (std::size_t i = 0; i < impulses.size(); ++i) impulses[i] -= others.contacts[i].impulse;
		for (std::size_t k = 0; k < torques.size(); ++k) torques[k] -= others.rolling[k].torque;
	}
};

} // namespace contactdynamics
