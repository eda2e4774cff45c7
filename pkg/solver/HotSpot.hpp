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

	struct PackLane {		 // where a contact stands
		std::int32_t number; // of the pack, times packLanes, plus the lane
		bool ball;
	};

	std::size_t room = mostContacts; ///< loaded contacts of a part at most
	std::size_t awake = 0;			 ///< contacts that a sweep of the collection visits
	std::size_t parts = 0;
	std::vector<PackLane> contacts;		  ///< part by part, in each first the balls, all in the order of their packs
	std::vector<std::size_t> firstOfPart; ///< and one more, where the last one ends

	// For GrainOperator alone.
	struct Change {
		double size2; // dr^T W dr [J]
		PackLane of;
	};
	struct Near { // a contact that may become part of the spot
		PackLane of;
		std::int32_t body1, body2; // their numbers, -1: cannot move
		bool loaded, chosen;
	};
	enum class Candidate : std::uint8_t { untried, in, refused }; // a body with a large change; in: with all its contacts
	struct Group {												  // bodies and the chosen contacts that link them
		std::size_t loaded = 0;									  // contacts
		std::int32_t part = -1, seenBy = -1;					  // body that asked last
		void add(const Group& other) { loaded += other.loaded; }
	};
	std::vector<Change> changes;			 // the largest first
	std::vector<std::int32_t> numberOf;		 // of a body, by seat, -1: none; candidates come first
	std::vector<Candidate> candidates;		 // by number
	std::vector<Near> near;					 // contacts of candidates
	std::vector<std::size_t> firstNear;		 // of each candidate, in nearOf
	std::vector<std::int32_t> nearOf;		 // candidate by candidate its contacts
	JoinedGroups<Group> groups;				 // of numbered bodies
	std::vector<std::int32_t> bodyOf, seats; // of the part taken last: by seat, -1 for all between two parts; of each of its bodies
};

} // namespace contactdynamics
