// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Engine.hpp>

namespace yade {

/// An engine that acts on the scene as a whole.
class GlobalEngine : public Engine {
	YADE_STOCK_SERIALIZABLE(GlobalEngine)
	GlobalEngine() {}
};

} // namespace yade

YADE_STOCK_SERIALIZERS(GlobalEngine)
