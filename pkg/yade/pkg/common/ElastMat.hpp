// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Material.hpp>

namespace yade {

class ElastMat : public Material {
	YADE_STOCK_SERIALIZABLE(ElastMat)
	YADE_STOCK_INDEXABLE(ElastMat)

	Real young; ///< [Pa]
	Real poisson;

	ElastMat() = delete;
};

class FrictMat : public ElastMat {
	YADE_STOCK_SERIALIZABLE(FrictMat)
	YADE_STOCK_INDEXABLE(FrictMat)

	Real frictionAngle; ///< [rad]

	FrictMat();
};

} // namespace yade

YADE_STOCK_SERIALIZERS(ElastMat)
YADE_STOCK_SERIALIZERS(FrictMat)
