// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainProblem.hpp"

#include <cstddef>
#include <vector>

namespace contactdynamics {

/// The contacts around the largest changes of a sweep, as a problem of their own; all others keep their impulses. Filled by GrainOperator.
struct HotSpot {
	/// Loaded contacts at most, a few grains with all theirs; half as many after one that could not be solved. With 128 solves take up to twice the
	/// time.
	static constexpr std::size_t mostContacts = 64, fewestContacts = 16;
	static constexpr std::size_t contactsPerSpot = 1500; ///< larger collections have room for so many times as much
	/// Of the changes, squared: at least so much has to lie in the spot, and no more than so much is asked for.
	static constexpr double leastShare = 0.3, enough = 0.9;

	std::size_t room = mostContacts; ///< loaded contacts at most
	GrainProblem problem;			 ///< impulses: the present ones; bodies: as they would be without these
	std::vector<double> impulse2;	 ///< r^T W r of each contact, at the start [J]
	std::size_t awake = 0;			 ///< contacts that a sweep of the collection visits

	// For GrainOperator alone.
	struct Origin {
		std::int32_t place; // pack and lane
		bool ball;
	};
	struct Change {
		double size2; // dr^T W dr [J]
		Origin of;
	};
	std::vector<Origin> origins;			// parallel to problem.contacts
	std::vector<Change> changes;			// the largest first
	std::vector<std::size_t> loaded;		// contacts that come with each of them
	std::vector<std::int32_t> rank, bodyOf; // by seat; bodyOf is -1 for all between two spots
	std::vector<std::int32_t> seats;		// of the bodies in the problem
};

} // namespace contactdynamics
