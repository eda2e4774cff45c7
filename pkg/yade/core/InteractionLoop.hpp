// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Dispatching.hpp>
#include <core/GlobalEngine.hpp>

namespace yade {

/// Runs the functors for geometry, physics and law over all interactions.
class InteractionLoop : public GlobalEngine {
	YADE_STOCK_SERIALIZABLE(InteractionLoop)
private:
	abi::Opaque<104, 136> eraseAfterLoop;

public:
	shared_ptr<IGeomDispatcher> geomDispatcher;
	shared_ptr<IPhysDispatcher> physDispatcher;
	shared_ptr<LawDispatcher> lawDispatcher;

private:
	abi::Opaque<184, 209> callbacksAndOrder;

public:
	InteractionLoop();
	void action() override;
};

} // namespace yade
