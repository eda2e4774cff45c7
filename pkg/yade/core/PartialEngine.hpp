// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Engine.hpp>

namespace yade {

/// An engine that acts on the bodies listed in `ids`.
class PartialEngine : public Engine {
	YADE_STOCK_SERIALIZABLE(PartialEngine)
	vector<int> ids;
	PartialEngine() {}
};

} // namespace yade

YADE_STOCK_SERIALIZERS(PartialEngine)
