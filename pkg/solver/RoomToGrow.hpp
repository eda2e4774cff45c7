// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>

namespace contactdynamics {

/// Room for so many elements, and for as many again where memory is taken anew: a packing that gets denser has more contacts in each step, and each
/// time all would be copied, to pages that the system has yet to hand out. With an eighth instead, that was half of the time to collect a scene that
/// comes together. Room that is never written to takes no memory.
template <class Vector> void reserveWithRoom(Vector& vector, std::size_t count)
{
	if (vector.capacity() < count) vector.reserve(2 * count);
}

template <class Vector> void resizeWithRoom(Vector& vector, std::size_t count)
{
	reserveWithRoom(vector, count);
	vector.resize(count);
}

} // namespace contactdynamics
