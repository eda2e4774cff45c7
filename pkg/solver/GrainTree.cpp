// SPDX-License-Identifier: GPL-2.0-or-later
// Where the awake contacts lie: node by node of the tree of bodies, within a node by colour.
#include "Buckets.hpp"
#include "GrainOperator.hpp"

namespace contactdynamics {

namespace {

constexpr int kinds = 2 * Colouring::colours; // balls and general contacts of each colour

/// How often to halve until a part has no more than so many contacts.
int halvings(std::size_t contacts, std::size_t most)
{
	int count = 0;
	for (; contacts > most; contacts /= 2) ++count;
	return count;
}

/// A pack whose lanes all refer to this body.
template <class Pack> Pack emptyPack(std::int32_t body)
{
	Pack empty{};
	for (int lane = 0; lane < packLanes; ++lane) {
		empty.id[lane] = -1;
		empty.body1[lane] = empty.body2[lane] = ~body;
	}
	return empty;
}

} // namespace

void GrainOperator::takeSeats()
{
	// The bodies of a block, their velocities with those of the last sweep and the search direction, and the packs that stream through fill half a
	// megabyte of cache.
	constexpr std::size_t contactsPerBlock = 4000;
	const std::size_t count = problem->contacts.size();
	const int levels = isWorthThreads(count) ? std::min(halvings(count, contactsPerRegion), mostLevels) : 0;
	tree.build(*problem, movable, levels, std::max(levels, halvings(count, contactsPerBlock)), *crew);
}

/// Appends contacts node by node, each node as one chunk; the first time with the bodies of the blocks.
void GrainOperator::layOut(const std::vector<std::int32_t>& ids)
{
	if (ids.empty()) return;
	const bool isFirst = passes.empty();
	if (isFirst) colouring.reset(problem->bodies.size());
	colourOf.resize(ids.size());
	order.resize(ids.size());
	// A few that wake later are one node, for one thread: a node for each would leave most lanes of their packs empty.
	const bool isShared = tree.regions() > 1 && ids.size() > contactsPerRegion, byTree = isFirst || isShared;
	inRuns(ids.size(), [&](std::size_t i) { colourOf[i] = byTree ? std::int32_t(tree.of(problem->contacts[ids[i]])) : 0; });
	const auto eachNode = [&](const auto& put) {
		for (std::size_t i = 0; i < ids.size(); ++i) put(std::size_t(colourOf[i]), ids[i]);
	};
	intoBuckets(tree.nodes(), eachNode, firstOfNode, byNode);

	nodeChunks.resize(tree.nodes());
	overJobs([&](std::size_t job) {
		for (std::size_t n = tree.firstNode(job); n < tree.firstNode(job + 1); ++n) colourNode(n);
	});
	Pass pass{chunks.size(), 0, jobs.size(), isShared};
	std::size_t packCount = packs.size(), generalCount = generals.size();
	for (std::size_t job = 0; job < tree.jobs(); ++job) {
		const std::size_t firstChunk = chunks.size();
		for (std::size_t n = tree.firstNode(job); n < tree.firstNode(job + 1); ++n) {
			Chunk& chunk = nodeChunks[n];
			const bool takesBodies = isFirst && n < tree.blocks();
			chunk.firstPack = packCount;
			chunk.firstGeneral = generalCount;
			chunk.firstSeat = takesBodies ? tree.firstSeat[n] : 0;
			chunk.lastSeat = takesBodies ? tree.firstSeat[n + 1] : 0;
			packCount += chunk.packs;
			generalCount += chunk.generals;
			if (takesBodies || chunk.packs + chunk.generals > 0) chunks.push_back(chunk);
		}
		if (pass.isShared) jobs.push_back({firstChunk, chunks.size()});
	}
	pass.lastChunk = chunks.size();
	passes.push_back(pass);
	packs.grow(packCount);
	generals.grow(generalCount);
	if (!rollingContacts.empty()) {
		rollingPacks.grow(packCount);
		rollingGenerals.grow(generalCount);
	}
	share(tree.nodes(), [&](std::size_t n) { fillNode(n); });
	awake += ids.size();
}

/// Sorts the contacts of a node by colour and counts its packs.
void GrainOperator::colourNode(std::size_t node)
{
	const std::size_t first = firstOfNode[node], last = firstOfNode[node + 1];
	const auto& contacts = problem->contacts;
	std::size_t next[kinds + 1] = {};
	for (std::size_t i = first; i < last; ++i) {
		const Contact& c = contacts[byNode[i]];
		colourOf[i] = 2 * colouring.assign(indexOf(c.body1), indexOf(c.body2)) + (isBall(c) ? 0 : 1);
		++next[colourOf[i] + 1];
	}
	Chunk& chunk = nodeChunks[node];
	chunk.packs = chunk.generals = 0;
	for (int kind = 0; kind < kinds; ++kind) {
		const std::size_t lanes = Colouring::lanes(kind / 2);
		(kind % 2 == 0 ? chunk.packs : chunk.generals) += (next[kind + 1] + lanes - 1) / lanes;
	}
	next[0] = first;
	for (int kind = 0; kind < kinds; ++kind) next[kind + 1] += next[kind];
	for (std::size_t i = first; i < last; ++i) {
		const Contact& c = contacts[byNode[i]];
		colouring.forget(indexOf(c.body1), indexOf(c.body2));
		order[next[colourOf[i]]++] = byNode[i];
	}
	// Where each kind ends is known now: colours in the new order.
	std::size_t i = first;
	for (int kind = 0; kind < kinds; ++kind)
		for (; i < next[kind]; ++i) colourOf[i] = kind;
}

void GrainOperator::fillNode(std::size_t node)
{
	const Chunk& chunk = nodeChunks[node];
	const auto nobody = std::int32_t(problem->bodies.size()); // at rest, after all others
	const auto emptyBall = emptyPack<BallPack>(nobody);
	const auto emptyGeneral = emptyPack<GeneralPack>(nobody);
	std::size_t next[]{chunk.firstPack, chunk.firstGeneral}; // pack of each sort
	std::size_t at = 0, lane = 0;
	int before = -1;
	for (std::size_t i = firstOfNode[node]; i < std::size_t(firstOfNode[node + 1]); ++i) {
		const int kind = colourOf[i], isGeneral = kind % 2;
		if (kind != before || lane == Colouring::lanes(kind / 2)) {
			at = next[isGeneral]++;
			lane = 0;
			if (isGeneral)
				generals[at] = emptyGeneral;
			else
				packs[at] = emptyBall;
			if (!rollingContacts.empty()) (isGeneral ? rollingGenerals : rollingPacks)[at] = RollingPack{};
		}
		if (isGeneral)
			putGeneral(at, int(lane++), order[i]);
		else
			putBall(at, int(lane++), order[i]);
		before = kind;
	}
}

} // namespace contactdynamics
