// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/GlobalEngine.hpp>

namespace yade {

/// An engine that moves the boundary of a scene.
class BoundaryController : public GlobalEngine {
	YADE_STOCK_SERIALIZABLE(BoundaryController)

	BoundaryController() = delete;
	void action() override;
};

} // namespace yade
