// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/serialization/Serializable.hpp>
#include <core/Timing.hpp>

namespace yade {

class Scene;

/// One part of a simulation step; the scene runs its engines in order.
class Engine : public Serializable {
	YADE_STOCK_SERIALIZABLE(Engine)

	Scene* scene; ///< set by the scene before `action`; null or stale before
	TimingInfo timingInfo;
	shared_ptr<TimingDeltas> timingDeltas;
	bool dead;
	int ompThreads;
	string label;

	Engine();
	virtual bool isActivated();
	virtual void action();
};

} // namespace yade

YADE_STOCK_SERIALIZERS(Engine)
