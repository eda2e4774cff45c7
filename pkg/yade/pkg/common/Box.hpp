// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Shape.hpp>

namespace yade {

class Box : public Shape {
	YADE_STOCK_SERIALIZABLE(Box)
	YADE_STOCK_INDEXABLE(Box)
	Vector3r extents; ///< half the edges [m]
	Box() = delete;
};

} // namespace yade
