// SPDX-License-Identifier: GPL-2.0-or-later
#include "BodyBlocks.hpp"

#include <algorithm>

namespace contactdynamics {

void BodyBlocks::build(const GrainProblem& problem, const std::vector<std::uint8_t>& movable, std::size_t bodiesPerBlock)
{
	findNeighbours(problem, movable);
	grow(movable, bodiesPerBlock);
	findConflicts();
	paint();
	takeSeats();
}

void BodyBlocks::findNeighbours(const GrainProblem& problem, const std::vector<std::uint8_t>& movable)
{
	const auto isLink = [&](const Contact& c) { return movable[c.body1] && movable[c.body2]; };
	firstNeighbour.assign(problem.bodies.size() + 2, 0);
	for (const Contact& c : problem.contacts) {
		if (!isLink(c)) continue;
		++firstNeighbour[c.body1 + 2];
		++firstNeighbour[c.body2 + 2];
	}
	for (std::size_t i = 2; i < firstNeighbour.size(); ++i) firstNeighbour[i] += firstNeighbour[i - 1];
	neighbours.resize(std::size_t(firstNeighbour.back()));
	// While it is filled, firstNeighbour[i + 1] is the next free place of body i; afterwards it is the first place of body i + 1.
	for (const Contact& c : problem.contacts) {
		if (!isLink(c)) continue;
		neighbours[std::size_t(firstNeighbour[c.body1 + 1]++)] = c.body2;
		neighbours[std::size_t(firstNeighbour[c.body2 + 1]++)] = c.body1;
	}
}

void BodyBlocks::grow(const std::vector<std::uint8_t>& movable, std::size_t bodiesPerBlock)
{
	const std::size_t bodies = movable.size();
	block.assign(bodies, -1);
	reached.assign(bodies, -1);
	grown.clear();
	seeds.clear();
	size.clear();
	std::size_t nextSeed = 0, nextBody = 0;
	const auto isFree = [&](std::int32_t i) { return movable[i] && block[i] < 0; };
	const auto seed = [&]() -> std::int32_t {
		while (nextSeed < seeds.size())
			if (const std::int32_t i = seeds[nextSeed++]; isFree(i)) return i;
		while (nextBody < bodies)
			if (const auto i = std::int32_t(nextBody++); isFree(i)) return i;
		return -1;
	};
	for (std::int32_t first = seed(); first >= 0;) {
		const auto now = std::int32_t(size.size());
		const std::size_t start = grown.size();
		// The queue of the search is the tail of `grown`; what is left of it when the block is full are seeds.
		std::size_t taken = start;
		while (first >= 0 && taken - start < bodiesPerBlock) {
			reached[first] = now;
			grown.push_back(first);
			for (; taken < grown.size() && taken - start < bodiesPerBlock; ++taken) {
				const std::int32_t i = grown[taken];
				block[i] = now;
				for (std::int32_t k = firstNeighbour[i]; k < firstNeighbour[i + 1]; ++k) {
					const std::int32_t j = neighbours[k];
					if (block[j] >= 0 || reached[j] == now) continue;
					reached[j] = now;
					grown.push_back(j);
				}
			}
			if (taken - start < bodiesPerBlock) first = seed();
		}
		seeds.insert(seeds.end(), grown.begin() + std::ptrdiff_t(taken), grown.end());
		grown.resize(taken);
		size.push_back(std::int32_t(taken - start));
		if (first >= 0) first = seed();
	}
	if (size.empty()) size.push_back(0); // contacts between bodies that cannot move have to go somewhere
}

/// All blocks that meet at a body, its own and those of its neighbours, are in conflict.
void BodyBlocks::findConflicts()
{
	const std::size_t words = (size.size() + 63) / 64;
	conflicts.assign(size.size() * words, 0);
	for (const std::int32_t i : grown) {
		here.assign(1, block[i]);
		for (std::int32_t k = firstNeighbour[i]; k < firstNeighbour[i + 1]; ++k) {
			const std::int32_t other = block[neighbours[k]];
			if (std::find(here.begin(), here.end(), other) == here.end()) here.push_back(other);
		}
		for (const std::int32_t a : here)
			for (const std::int32_t b : here)
				if (a != b) conflicts[std::size_t(a) * words + std::size_t(b) / 64] |= std::uint64_t(1) << (b % 64);
	}
}

/// Greedy, in the order of growth: of the colours that are free, the one with the fewest blocks, so that all colours have work for many threads.
void BodyBlocks::paint()
{
	const std::size_t words = (size.size() + 63) / 64;
	colour.assign(size.size(), -1);
	members.clear();
	metBy.clear();
	for (std::size_t b = 0; b < size.size(); ++b) {
		for (std::size_t w = 0; w < words; ++w)
			for (std::uint64_t bits = conflicts[b * words + w]; bits; bits &= bits - 1) {
				const std::size_t other = w * 64 + std::size_t(__builtin_ctzll(bits));
				if (colour[other] >= 0) metBy[colour[other]] = std::int32_t(b);
			}
		std::int32_t best = -1;
		for (std::size_t k = 0; k < members.size(); ++k)
			if (metBy[k] != std::int32_t(b) && (best < 0 || members[k] < members[best])) best = std::int32_t(k);
		if (best < 0) {
			best = std::int32_t(members.size());
			members.push_back(0);
			metBy.push_back(-1);
		}
		colour[b] = best;
		++members[best];
	}
	firstBlock.assign(1, 0);
	for (const std::int32_t blocks : members) firstBlock.push_back(firstBlock.back() + blocks);
	for (std::size_t k = 0; k < members.size(); ++k) members[k] = firstBlock[k];
	number.resize(size.size());
	for (std::size_t b = 0; b < size.size(); ++b) number[b] = members[colour[b]]++;
}

void BodyBlocks::takeSeats()
{
	firstSeat.assign(size.size() + 1, 0);
	for (std::size_t b = 0; b < size.size(); ++b) firstSeat[number[b] + 1] = size[b];
	for (std::size_t b = 0; b < size.size(); ++b) firstSeat[b + 1] += firstSeat[b];
	seat.assign(block.size(), -1);
	std::size_t i = 0;
	for (std::size_t b = 0; b < size.size(); ++b)
		for (std::int32_t k = 0; k < size[b]; ++k) seat[grown[i++]] = firstSeat[number[b]] + k;
	std::int32_t last = firstSeat.back();
	for (std::size_t body = 0; body < block.size(); ++body) {
		if (block[body] < 0)
			seat[body] = last++;
		else
			block[body] = number[block[body]];
	}
}

} // namespace contactdynamics
