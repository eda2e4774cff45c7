// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainProblem.hpp"

namespace contactdynamics {

/// The moving bodies of a large problem in blocks of neighbours, so that a sweep meets a body once, while its block is in the cache, and not once a
/// colour of contacts.
///
/// A block grows from a seed through the graph of the contacts, breadth first; seeds are the oldest neighbours of the blocks before. Blocks are
/// coloured: two of one colour have no contact with each other and none with a common body of a third one. They are numbered colour by colour, and a
/// contact belongs to the later block of its two bodies. So blocks of one colour can be visited at the same time, and the bodies of other blocks that
/// a block meets have all been met in the sweep before. All of it is a function of the problem alone.
class BodyBlocks {
public:
	/// @param movable  whether an impulse can move the body
	void build(const GrainProblem& problem, const std::vector<std::uint8_t>& movable, std::size_t bodiesPerBlock);

	std::size_t count() const { return firstSeat.size() - 1; }
	/// Which block visits a contact; contacts between bodies that cannot move go to the first.
	std::int32_t of(const Contact& c) const { return std::max(0, std::max(block[c.body1], block[c.body2])); }

	std::vector<std::int32_t> block; ///< of each body, -1 for one that cannot move
	std::vector<std::int32_t> seat;	 ///< of each body: place in an order in which those of a block are together; bodies that cannot move come last
	std::vector<std::int32_t> firstSeat;  ///< of each block, one past the last block: seats of its bodies
	std::vector<std::int32_t> firstBlock; ///< of each colour, one past the last colour

private:
	std::vector<std::int32_t> firstNeighbour, neighbours; // moving bodies that touch each body
	std::vector<std::int32_t> grown;					  // bodies block by block
	std::vector<std::int32_t> seeds, reached;			  // queue of neighbours of closed blocks; block that has reached a body last
	std::vector<std::int32_t> size, colour, number;		  // of each block, in the order of growth: bodies, colour, number
	std::vector<std::uint64_t> conflicts;				  // matrix of bits
	std::vector<std::int32_t> here;						  // blocks that meet at a body
	std::vector<std::int32_t> members, metBy;			  // of each colour: its blocks; the last block that was found in conflict with it

	void findNeighbours(const GrainProblem& problem, const std::vector<std::uint8_t>& movable);
	void grow(const std::vector<std::uint8_t>& movable, std::size_t bodiesPerBlock);
	void findConflicts();
	void paint();
	void takeSeats();
};

} // namespace contactdynamics
