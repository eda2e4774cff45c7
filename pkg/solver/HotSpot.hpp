// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "JoinedGroups.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace contactdynamics {

/// The contacts around the largest changes of a sweep, in parts that are problems of their own; all others keep their impulses. Chosen by
/// GrainOperator.
struct HotSpot {
	/// Loaded contacts of a part at most, a few grains with all theirs; half as many after one that could not be solved. With 128 solves take up to
	/// twice the time.
	static constexpr std::size_t mostContacts = 64, fewestContacts = 16;
	static constexpr std::size_t contactsPerSpot = 1500; ///< larger collections have room for so many times as much, in several parts
	/// Of the changes, squared: at least so much has to lie in the spot, and no more than so much is asked for.
	static constexpr double leastShare = 0.3, enough = 0.9;

	struct Origin {
		std::int32_t place; // pack and lane
		bool ball;
	};

	std::size_t room = mostContacts; ///< loaded contacts of a part at most
	std::size_t awake = 0;			 ///< contacts that a sweep of the collection visits
	std::size_t parts = 0;
	std::vector<std::vector<Origin>> contacts; ///< of each part, in the order of a sweep; lists beyond the parts are room of before

	// For GrainOperator alone.
	struct Change {
		double size2; // dr^T W dr [J]
		Origin of;
	};
	struct Near { // a contact that may become part of the spot
		Origin of;
		std::int32_t body1, body2; // their numbers, -1: cannot move
		bool loaded, chosen;
	};
	struct Group { // contacts linked by bodies
		std::size_t loaded = 0;
		std::int32_t part = -1;
		void add(const Group& other) { loaded += other.loaded; }
	};
	std::vector<Change> changes;				   // the largest first
	std::vector<std::int32_t> numberOf;			   // of a body, by seat, -1: none; the candidates, that have one of these changes, come first
	std::size_t candidates = 0, bodies = 0;		   // so many
	std::vector<Near> near;						   // contacts of candidates
	std::vector<std::vector<std::int32_t>> around; // of each candidate those contacts
	std::vector<std::uint8_t> isIn;				   // the candidate, with all its contacts
	std::vector<Group*> linked;					   // by one more body
	JoinedGroups<Group> groups;					   // of numbered bodies
	std::vector<std::int32_t> bodyOf, seats;	   // of the part taken last: by seat, -1 for all between two parts; of each of its bodies
};

} // namespace contactdynamics
