// SPDX-License-Identifier: GPL-2.0-or-later
// The layout of a problem beyond the caches: block by block of neighbouring bodies, within a block by colour.
#include "GrainOperator.hpp"

namespace contactdynamics {

namespace {

constexpr int kinds = 2 * Colouring::colours; // balls and general contacts of each colour

/// A thousand bodies, their velocities with those of the last sweep and the search direction, and the packs that stream through fill half a megabyte
/// of cache. Smaller problems are cut finer, to the benefit of threads. The conflicts of blocks are a matrix: no more than a few thousand.
std::size_t bodiesPerBlock(std::size_t bodies)
{
	constexpr std::size_t least = 250, most = 1000, fewBlocks = 64, manyBlocks = 4096;
	return std::max(std::min(std::max(bodies / fewBlocks, least), most), bodies / manyBlocks);
}

} // namespace

void GrainOperator::takeSeats()
{
	blockwise = problem->contacts.size() >= blockwiseFrom;
	seat.resize(movable.size());
	if (blockwise) blocks.build(*problem, movable, bodiesPerBlock(movable.size()));
	for (std::size_t i = 0; i < seat.size(); ++i) seat[i] = blockwise ? blocks.seat[i] : std::int32_t(i);
}

/// Appends contacts block by block, each block as one chunk; the first time with the blocks' bodies.
void GrainOperator::layOutByBlock(const std::vector<std::int32_t>& ids)
{
	const bool isFirst = groups.empty();
	if (isFirst) colouring.reset(problem->bodies.size());
	colourOf.resize(ids.size());
	byBlock.resize(ids.size());
	order.resize(ids.size());
	inRuns(ids.size(), [&](std::size_t i) { colourOf[i] = blocks.of(problem->contacts[ids[i]]); });
	firstOfBlock.assign(blocks.count() + 2, 0);
	for (const std::int32_t block : colourOf) ++firstOfBlock[block + 2];
	for (std::size_t b = 2; b < firstOfBlock.size(); ++b) firstOfBlock[b] += firstOfBlock[b - 1];
	for (std::size_t i = 0; i < ids.size(); ++i) byBlock[firstOfBlock[colourOf[i] + 1]++] = ids[i];

	blockChunks.resize(blocks.count());
	for (std::size_t k = 0; k + 1 < blocks.firstBlock.size(); ++k) {
		const std::size_t first = blocks.firstBlock[k];
		share(blocks.firstBlock[k + 1] - first, [&](std::size_t i) { colourBlock(first + i); });
	}
	std::size_t packCount = packs.size(), generalCount = generals.size();
	for (std::size_t k = 0; k + 1 < blocks.firstBlock.size(); ++k) {
		const std::size_t firstChunk = chunks.size();
		for (std::int32_t b = blocks.firstBlock[k]; b < blocks.firstBlock[k + 1]; ++b) {
			Chunk& chunk = blockChunks[b];
			chunk.firstPack = packCount;
			chunk.firstGeneral = generalCount;
			chunk.firstSeat = isFirst ? blocks.firstSeat[b] : 0;
			chunk.lastSeat = isFirst ? blocks.firstSeat[b + 1] : 0;
			packCount += chunk.packs;
			generalCount += chunk.generals;
			if (isFirst || chunk.packs + chunk.generals > 0) chunks.push_back(chunk);
		}
		if (chunks.size() > firstChunk) groups.push_back({firstChunk, chunks.size()});
	}
	resizePacks(packCount);
	generals.resize(generalCount);
	share(blocks.count(), [&](std::size_t b) { fillBlock(b); });
}

/// Sorts the contacts of a block by colour and counts its packs.
void GrainOperator::colourBlock(std::size_t block)
{
	const std::size_t first = firstOfBlock[block], last = firstOfBlock[block + 1];
	const auto& contacts = problem->contacts;
	std::size_t next[kinds + 1] = {};
	for (std::size_t i = first; i < last; ++i) {
		const Contact& c = contacts[byBlock[i]];
		colourOf[i] = 2 * colouring.assign(indexOf(c.body1), indexOf(c.body2)) + (isBall(c) ? 0 : 1);
		++next[colourOf[i] + 1];
	}
	Chunk& chunk = blockChunks[block];
	chunk.packs = chunk.generals = 0;
	for (int kind = 0; kind < kinds; ++kind) {
		if (kind % 2 == 0)
			chunk.packs += (next[kind + 1] + Colouring::lanes(kind / 2) - 1) / Colouring::lanes(kind / 2);
		else
			chunk.generals += next[kind + 1];
	}
	next[0] = first;
	for (int kind = 0; kind < kinds; ++kind) next[kind + 1] += next[kind];
	for (std::size_t i = first; i < last; ++i) {
		const Contact& c = contacts[byBlock[i]];
		colouring.forget(indexOf(c.body1), indexOf(c.body2));
		order[next[colourOf[i]]++] = byBlock[i];
	}
	// Where each kind ends is known now: colours in the new order.
	std::size_t i = first;
	for (int kind = 0; kind < kinds; ++kind)
		for (; i < next[kind]; ++i) colourOf[i] = kind;
}

void GrainOperator::fillBlock(std::size_t block)
{
	const Chunk& chunk = blockChunks[block];
	std::size_t pack = chunk.firstPack, general = chunk.firstGeneral, lane = 0;
	int before = -1;
	for (std::size_t i = firstOfBlock[block]; i < std::size_t(firstOfBlock[block + 1]); ++i) {
		const int kind = colourOf[i];
		if (kind % 2 == 1) {
			putGeneral(generals[general++], order[i]);
			continue;
		}
		if (before >= 0 && (kind != before || lane == Colouring::lanes(kind / 2))) {
			++pack;
			lane = 0;
		}
		putBall(pack, int(lane++), order[i]);
		before = kind;
	}
}

} // namespace contactdynamics
