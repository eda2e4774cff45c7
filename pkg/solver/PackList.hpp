// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "RoomToGrow.hpp"

#include <vector>

namespace contactdynamics {

/// Packs in a row, anew in each solve. Those that grow() adds hold what an earlier layout has left: whoever lays contacts out overwrites each as it
/// begins it, and again lane by lane while it is in the cache. Going over all memory beforehand took longer than a sweep.
template <class Pack> class PackList {
public:
	std::size_t size() const { return count; }
	Pack* data() { return store.data(); }
	const Pack* data() const { return store.data(); }
	Pack& operator[](std::size_t i) { return store[i]; }
	const Pack& operator[](std::size_t i) const { return store[i]; }
	Pack* begin() { return store.data(); }
	Pack* end() { return store.data() + count; }
	const Pack* begin() const { return store.data(); }
	const Pack* end() const { return store.data() + count; }

	void clear() { count = 0; }
	void grow(std::size_t to)
	{
		reserveWithRoom(store, to);
		if (to > store.size()) store.resize(to);
		count = to;
	}

private:
	std::vector<Pack> store; // as many as there ever were
	std::size_t count = 0;
};

} // namespace contactdynamics
