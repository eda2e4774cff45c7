// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Shape.hpp>

namespace yade {

/// An infinite plane perpendicular to an axis, through the body's position.
class Wall : public Shape {
	YADE_STOCK_SERIALIZABLE(Wall)
	YADE_STOCK_INDEXABLE(Wall)

	int sense; ///< -1: solid on the negative side only, 1: positive, 0: both
	int axis;  ///< 0, 1 or 2

	Wall() = delete;
};

} // namespace yade
