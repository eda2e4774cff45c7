// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "Crew.hpp"
#include "GrainProblem.hpp"

namespace contactdynamics {

/// The moving bodies, halved again and again across their longest extent: 2^depth blocks of neighbours with about as many contacts each. The upper
/// levels of the tree make 2^levels regions, runs of blocks.
///
/// Contacts belong to jobs, each for one thread. A contact within a region is the region's, any other one the joint's where the ways to its two
/// regions part. A joint has its bodies to itself once its two parts are done, so one core can go from the regions of half of the tree up to their
/// last joint without meeting another core. The topmost joints would be work for few: they are divided into pairs of a part on the left and one on
/// the right, numbers l and r; pairs with the same l ^ r have no part in common, and are a stage. All of it is a function of the problem alone.
class BodyTree {
public:
	/// @param movable  whether an impulse can move the body;  @param depth  >= levels
	void build(const GrainProblem& problem, const std::vector<std::uint8_t>& movable, int levels, int depth, Crew& crew);

	std::size_t regions() const { return std::size_t(1) << upper; }
	std::size_t blocks() const { return std::size_t(1) << lower; }
	/// Jobs are numbered in the order of a sweep: regions, joints level by level, pairs stage by stage.
	std::size_t jobs() const { return firstPair() + stages() * pairsPerStage(); }
	/// Joints of the levels 1 to so many above the regions are jobs, those further up are divided.
	int undivided() const { return upper - upper / 3; }
	/// The job of the k-th joint of a level; regions are the joints of level 0.
	std::size_t joint(int level, std::size_t k) const { return 2 * regions() - (2 * regions() >> level) + k; }
	std::size_t firstPair() const { return joint(undivided() + 1, 0); }
	std::size_t stages() const { return 2 * pairsPerStage() - 2; }
	std::size_t pairsPerStage() const { return std::size_t(1) << (upper - undivided()); }

	/// Nodes are what contacts are sorted into: the blocks, of which a region has a run, then the other jobs, one node each.
	std::size_t nodes() const { return firstNode(jobs()); }
	std::size_t firstNode(std::size_t job) const { return job < regions() ? job << (lower - upper) : job - regions() + blocks(); }
	/// The node of a contact: in a region the later block of its two bodies; the first block where neither can move.
	std::size_t of(const Contact& c) const;

	std::vector<std::int32_t> block; ///< of each body, -1 for one that cannot move
	std::vector<std::int32_t> seat;	 ///< of each body: place in an order in which those of a block are together; bodies that cannot move come last
	std::vector<std::int32_t> firstSeat; ///< of each block, one past the last block: seats of its bodies

private:
	struct Item { // a moving body; single precision tells neighbours well enough apart
		float centre[3];
		std::int32_t weight, body; // one more than its contacts
	};
	int upper = 0, lower = 0;
	std::vector<Item> items;
	std::vector<std::int32_t> weights;

	void collect(const GrainProblem& problem, const std::vector<std::uint8_t>& movable);
	std::int32_t halve(std::int32_t first, std::int32_t last);
};

} // namespace contactdynamics
