// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainProblem.hpp"

namespace contactdynamics {

/// Impulses at the contacts of a problem, and torques parallel to GrainProblem::rolling, global axes [N s], [N m s].
struct ImpulseSet {
	std::vector<Vector3> impulses, torques;

	/// What one solution of a problem has that another one lacks.
	static ImpulseSet between(const GrainProblem& less, const GrainProblem& more)
	{
		ImpulseSet added;
		for (std::size_t i = 0; i < more.contacts.size(); ++i) added.impulses.push_back(more.contacts[i].impulse - less.contacts[i].impulse);
		for (std::size_t k = 0; k < more.rolling.size(); ++k) added.torques.push_back(more.rolling[k].torque - less.rolling[k].torque);
		return added;
	}
};

} // namespace contactdynamics
