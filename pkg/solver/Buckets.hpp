// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace contactdynamics {

/// Counts items into place: those of bucket b stand in items[first[b]] ... items[first[b + 1] - 1], in the order in which they are put.
/// @param each  is called twice, with a function put(bucket, item); puts the same items in the same order both times
template <class Place, class Item, class Each>
void intoBuckets(std::size_t buckets, const Each& each, std::vector<Place>& first, std::vector<Item>& items)
{
	first.assign(buckets + 2, 0); // one place off, so that the starts become the ends
	each([&](std::size_t bucket, const Item&) { ++first[bucket + 2]; });
	std::partial_sum(first.begin(), first.end(), first.begin());
	items.resize(std::size_t(first.back()));
	each([&](std::size_t bucket, const Item& item) { items[std::size_t(first[bucket + 1]++)] = item; });
}

} // namespace contactdynamics
