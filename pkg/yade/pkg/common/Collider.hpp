// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Dispatching.hpp>
#include <core/GlobalEngine.hpp>

namespace yade {

/// Finds the pairs of bodies whose bounds overlap.
class Collider : public GlobalEngine {
	YADE_STOCK_SERIALIZABLE(Collider)

	shared_ptr<BoundDispatcher> boundDispatcher;
	mask_t avoidSelfInteractionMask;

	Collider() = delete;
	virtual vector<Body::id_t> probeBoundingVolume(const Bound& bound);
	/// Makes the next run start from scratch.
	virtual void invalidatePersistentData();
};

} // namespace yade
