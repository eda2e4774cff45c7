// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/PartialEngine.hpp>

namespace yade {

/// An engine that moves bodies in a prescribed way.
class KinematicEngine : public PartialEngine {
	YADE_STOCK_SERIALIZABLE(KinematicEngine)

	KinematicEngine() = delete;
};

/// The sum of such motions of the same bodies.
class CombinedKinematicEngine : public PartialEngine {
	YADE_STOCK_SERIALIZABLE(CombinedKinematicEngine)

	vector<shared_ptr<KinematicEngine>> comb;

	CombinedKinematicEngine() = delete;
};

} // namespace yade
