// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <unistd.h>

namespace yade {

/// The value at an address that may not be one: nothing instead of a crash. The kernel looks: writing from unmapped memory into a pipe fails with
/// EFAULT.
template <class Value> std::optional<Value> safelyRead(const void* address)
{
	int pipeEnds[2];
	if (pipe(pipeEnds) != 0) return {};
	Value value;
	const bool arrived = write(pipeEnds[1], address, sizeof value) == sizeof value && read(pipeEnds[0], &value, sizeof value) == sizeof value;
	close(pipeEnds[0]);
	close(pipeEnds[1]);
	if (!arrived) return {};
	return value;
}

} // namespace yade
