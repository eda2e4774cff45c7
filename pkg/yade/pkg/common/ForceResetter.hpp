// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/GlobalEngine.hpp>

namespace yade {

/// Zeroes the forces at the start of a step.
class ForceResetter : public GlobalEngine {
	YADE_STOCK_SERIALIZABLE(ForceResetter)
	ForceResetter() = delete;
};

} // namespace yade
