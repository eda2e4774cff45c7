// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/GlobalEngine.hpp>

namespace yade {

/// An engine that sets the time step of the scene.
class TimeStepper : public GlobalEngine {
	YADE_STOCK_SERIALIZABLE(TimeStepper)

	bool active = true;
	unsigned int timeStepUpdateInterval = 1; ///< [steps]

	TimeStepper() {}
	bool isActivated() override;
	void action() override;
	virtual void computeTimeStep(Scene* scene);
};

} // namespace yade

YADE_STOCK_SERIALIZERS(TimeStepper)
