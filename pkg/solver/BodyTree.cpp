// SPDX-License-Identifier: GPL-2.0-or-later
#include "BodyTree.hpp"

#include <algorithm>
#include <limits>

namespace contactdynamics {

void BodyTree::build(const GrainProblem& problem, const std::vector<std::uint8_t>& movable, int levels, int depth, Crew& crew)
{
	upper = levels;
	lower = depth;
	collect(problem, movable);
	firstSeat.assign(blocks() + 1, 0);
	firstSeat.back() = std::int32_t(items.size());
	for (int half = depth; half-- > 0;) // the parts are 2^(half + 1) blocks long
		crew.run(std::size_t(1) << (depth - half - 1), [&](std::size_t part) {
			const std::size_t first = part << (half + 1), middle = first + (std::size_t(1) << half);
			firstSeat[middle] = halve(firstSeat[first], firstSeat[middle + (std::size_t(1) << half)]);
		});

	block.assign(movable.size(), -1);
	seat.resize(movable.size());
	for (std::size_t b = 0; b < blocks(); ++b)
		for (std::int32_t i = firstSeat[b]; i < firstSeat[b + 1]; ++i) {
			block[items[i].body] = std::int32_t(b);
			seat[items[i].body] = i;
		}
	std::int32_t last = firstSeat.back();
	for (std::size_t body = 0; body < movable.size(); ++body)
		if (!movable[body]) seat[body] = last++;
}

std::size_t BodyTree::of(const Contact& c) const
{
	const std::int32_t one = block[c.body1], two = block[c.body2], earlier = std::min(one, two), later = std::max(one, two);
	const int toRegion = lower - upper;
	if (earlier < 0 || earlier >> toRegion == later >> toRegion) return std::size_t(std::max(0, later));
	const int left = earlier >> toRegion, right = later >> toRegion;
	int level = 1; // where the ways part
	while (left >> level != right >> level) ++level;
	const int common = left >> level, bits = level - undivided(); // to number the parts of each side with
	if (bits <= 0) return firstNode(joint(level, std::size_t(common)));
	const int parts = 1 << bits, below = undivided() - 1, l = (left >> below) & (parts - 1), r = (right >> below) & (parts - 1);
	const int stage = parts - 2 + (l ^ r);
	return firstNode(firstPair() + std::size_t(stage) * pairsPerStage() + std::size_t(common << bits) + std::size_t(l));
}

void BodyTree::collect(const GrainProblem& problem, const std::vector<std::uint8_t>& movable)
{
	weights.assign(movable.size(), 1);
	Vector3 low = Vector3::Zero(), high = Vector3::Zero();
	double extent = 0;
	if (lower > 0) { // or there is nothing to halve
		for (const Contact& c : problem.contacts) {
			++weights[c.body1];
			++weights[c.body2];
		}
		bool any = false;
		for (std::size_t i = 0; i < movable.size(); ++i) {
			if (!movable[i]) continue;
			const Vector3& centre = problem.bodies[i].centre;
			low = any ? low.cwiseMin(centre) : centre;
			high = any ? high.cwiseMax(centre) : centre;
			any = true;
		}
		extent = (high - low).maxCoeff();
	}
	const bool isSpread = extent > 0 && extent < std::numeric_limits<double>::infinity();
	items.clear();
	for (std::size_t i = 0; i < movable.size(); ++i) {
		if (!movable[i]) continue;
		const Vector3 at = isSpread ? Vector3((problem.bodies[i].centre - low) / extent) : Vector3(Vector3::Zero());
		items.push_back({{float(at[0]), float(at[1]), float(at[2])}, weights[i], std::int32_t(i)});
	}
}

/// Sorts items as far as is needed to halve their weight across their longest extent, by quickselect; returns where the second half begins.
std::int32_t BodyTree::halve(std::int32_t first, std::int32_t last)
{
	if (first == last) return first;
	float low[3] = {1, 1, 1}, high[3] = {0, 0, 0};
	std::int64_t goal = 0;
	for (std::int32_t i = first; i < last; ++i) {
		goal += items[i].weight;
		for (int k = 0; k < 3; ++k) {
			low[k] = std::min(low[k], items[i].centre[k]);
			high[k] = std::max(high[k], items[i].centre[k]);
		}
	}
	goal /= 2;
	// Of extents that hardly differ the first: parts on both sides of a joint are then halved alike, and meet in pairs.
	const float longest = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
	int axis = 0;
	while (high[axis] - low[axis] < 0.8F * longest) ++axis;
	// No two are equal: so a median of three has one below it, and which bodies end on which side does not depend on their order in memory. Three
	// from places as good as random: among the first, the last and the one half way, rows that turn back have no good pivot, and take a round for
	// each body.
	const auto isBelow = [axis](const Item& a, const Item& b) {
		return (a.centre[axis] < b.centre[axis]) | ((a.centre[axis] == b.centre[axis]) & (a.body < b.body));
	};
	constexpr std::int32_t few = 16;
	std::uint64_t random = 1;
	while (last - first > few) {
		const auto third = [&](int k) { // of the range, one item of it
			random = random * 6364136223846793005U + 1442695040888963407U;
			const auto length = std::uint64_t(last - first) / 3;
			return items[first + std::int32_t(std::uint64_t(k) * length + (random >> 33) % length)];
		};
		const Item a = third(0), b = third(1), c = third(2);
		const Item &smaller = isBelow(a, b) ? a : b, &larger = isBelow(a, b) ? b : a;
		const Item pivot = isBelow(c, smaller) ? smaller : isBelow(c, larger) ? c : larger;
		std::int64_t below = 0;
		std::int32_t middle = first;
		for (std::int32_t i = first; i < last; ++i) { // without a branch, which nobody could predict
			const Item item = items[i];
			const int goes = isBelow(item, pivot);
			items[i] = items[middle];
			items[middle] = item;
			middle += goes;
			below += goes * item.weight;
		}
		if (below <= goal) {
			goal -= below;
			first = middle;
		} else
			last = middle;
	}
	std::sort(items.begin() + first, items.begin() + last, isBelow);
	while (first < last && items[first].weight <= goal) goal -= items[first++].weight;
	return first;
}

} // namespace contactdynamics
