// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Shape.hpp>

namespace yade {

class Sphere : public Shape {
	YADE_STOCK_SERIALIZABLE(Sphere)
	YADE_STOCK_INDEXABLE(Sphere)
	Real radius; ///< [m]
	Sphere();
};

} // namespace yade

YADE_STOCK_SERIALIZERS(Sphere)
