// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace contactdynamics {

/// Groups 0 ... count - 1 that become fewer as they are joined (union-find). Group::add(other) takes over what the other one has.
template <class Group> class JoinedGroups {
public:
	void reset(std::size_t count)
	{
		parent.resize(count);
		std::iota(parent.begin(), parent.end(), 0);
		groups.assign(count, Group());
	}

	Group& of(std::int32_t member) { return groups[root(member)]; }
	void join(std::int32_t a, std::int32_t b)
	{
		const std::int32_t first = root(a), second = root(b);
		if (first == second) return;
		parent[second] = first;
		groups[first].add(groups[second]);
	}

private:
	std::vector<std::int32_t> parent;
	std::vector<Group> groups;

	std::int32_t root(std::int32_t i)
	{
		while (parent[i] != i) i = parent[i] = parent[parent[i]];
		return i;
	}
};

} // namespace contactdynamics
