// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BallPack.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace contactdynamics {

/// Greedy colouring: contacts of one colour share no moving body, so those of a pack can be visited at a time. First free colour, in the order given:
/// a function of the problem alone.
///
/// A colouring kept between steps and mended was rejected: the bits would depend on how the state was reached, also across save and load.
class Colouring {
public:
	static constexpr int overflow = 64; ///< colour of the contacts of a body that has more than 64: these are visited one by one
	static constexpr int colours = overflow + 1;
	static constexpr std::size_t lanes(int colour) { return colour == overflow ? 1 : packLanes; } ///< contacts of a colour that one pack may hold

	/// Forgets everything; no memory is given back.
	void reset(std::size_t bodies) { used.assign(bodies, 0); }

	/// Colour of a contact; a negative (complemented) index is a body that cannot move and never conflicts.
	int assign(std::int32_t body1, std::int32_t body2)
	{
		const std::uint64_t taken = (body1 < 0 ? 0 : used[body1]) | (body2 < 0 ? 0 : used[body2]);
		if (taken == ~std::uint64_t(0)) return overflow;
		const std::uint64_t bit = ~taken & (taken + 1);
		if (body1 >= 0) used[body1] |= bit;
		if (body2 >= 0) used[body2] |= bit;
		return __builtin_ctzll(bit);
	}

	/// As if the contact had never been, and all others of its bodies.
	void forget(std::int32_t body1, std::int32_t body2)
	{
		if (body1 >= 0) used[body1] = 0;
		if (body2 >= 0) used[body2] = 0;
	}

private:
	std::vector<std::uint64_t> used; // colours at each body
};

} // namespace contactdynamics
