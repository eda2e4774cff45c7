// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Dispatching.hpp>
#include <pkg/common/MatchMaker.hpp>
#include <pkg/common/NormShearPhys.hpp>

namespace yade {

class FrictPhys : public NormShearPhys {
	YADE_STOCK_SERIALIZABLE(FrictPhys)
	YADE_STOCK_INDEXABLE(FrictPhys)

	Real tangensOfFrictionAngle;

	FrictPhys();
};

} // namespace yade

YADE_STOCK_SERIALIZERS(FrictPhys)
