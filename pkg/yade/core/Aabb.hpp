// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Bound.hpp>

namespace yade {

/// A box with axes parallel to those of the frame; in a sheared periodic cell, to those of the sheared cell.
class Aabb : public Bound {
	YADE_STOCK_SERIALIZABLE(Aabb)
	YADE_STOCK_INDEXABLE(Aabb)
	Aabb();
};

} // namespace yade

YADE_STOCK_SERIALIZERS(Aabb)
